"""Error of reduced modal data against the full data, at the seats."""

import math

import numpy as np

from herringbone.housing.modal_model import ModalHousing

_SAME = 1e-9
"""Shapes of equal frequency that agree within this share of the largest are one mode: pseudo modes
of a residual matrix have one frequency, and others than they may have it after a reduction."""


def drive_point_errors(
    full: ModalHousing, reduced: ModalHousing, frequency_hz: np.ndarray
) -> np.ndarray:
    """Undamped difference of the receptance over the static compliance, (f, 12).

    Modes that both have cancel, so there is no resonance in it below the first mode that was
    dropped.

    Args:
        full, reduced: the data.
        frequency_hz: (f,) [Hz].
    """
    equal = full.frequency_hz[:, None] == reduced.frequency_hz
    apart = np.abs(full.seat_shapes[:, :, None] - reduced.seat_shapes[:, None, :]).max(axis=0)
    common = equal & (apart <= _SAME * np.abs(full.seat_shapes).max())
    difference = _rest(full, ~common.any(axis=1), frequency_hz)
    difference -= _rest(reduced, ~common.any(axis=0), frequency_hz)
    return np.abs(difference) / np.diag(full.static_compliance())


def _rest(housing: ModalHousing, own: np.ndarray, frequency_hz: np.ndarray) -> np.ndarray:
    """Drive-point receptance of the oscillators that are not common [m/N], (f, 12)."""
    squares = (2.0 * math.pi * housing.frequency_hz[own]) ** 2
    stiffness = squares - (2.0 * math.pi * frequency_hz[:, None]) ** 2
    return (1.0 / stiffness) @ (housing.seat_shapes[:, own] ** 2).T

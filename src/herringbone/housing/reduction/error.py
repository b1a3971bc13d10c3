"""Error of reduced modal data against the full data, at the seats."""

import math

import numpy as np

from herringbone.core import HerringboneError
from herringbone.core.wording import percent
from herringbone.housing.modal_model import ModalHousing
from herringbone.housing.reduction.reduced_housing import certified_bound

_SAME = 1e-9
"""Shapes of equal frequency that agree within this share of the largest are one mode: pseudo modes
of a residual matrix have one frequency, and others than they may have it after a reduction."""
_ROUNDING = 1e-9
"""Of an error that is computed, over the static compliance."""


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


def check_certificate(reduced: ModalHousing, band_hz: float, error: float) -> None:
    """Refuse a certificate that the full data disprove.

    Args:
        reduced: the data.
        band_hz: highest frequency of interest [Hz].
        error: largest of `drive_point_errors` up to there [1].

    Raises:
        HerringboneError: the error is above the certified bound.
    """
    bound = certified_bound(reduced, band_hz)
    if error > bound + _ROUNDING:
        raise HerringboneError(
            f"the error against the data up to {band_hz:g} Hz is {percent(error)}, above the "
            f"{percent(bound)} that the reduction certifies; use the data as they are"
        )


def _rest(housing: ModalHousing, own: np.ndarray, frequency_hz: np.ndarray) -> np.ndarray:
    """Drive-point receptance of the oscillators that are not common [m/N], (f, 12)."""
    squares = (2.0 * math.pi * housing.frequency_hz[own]) ** 2
    stiffness = squares - (2.0 * math.pi * frequency_hz[:, None]) ** 2
    return (1.0 / stiffness) @ (housing.seat_shapes[:, own] ** 2).T

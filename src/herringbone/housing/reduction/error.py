"""Error of reduced modal data against the full data, at the seats."""

import math

import numpy as np

from herringbone.housing.modal_model import ModalHousing


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
    common = set(full.frequency_hz) & set(reduced.frequency_hz)
    difference = _rest(full, common, frequency_hz) - _rest(reduced, common, frequency_hz)
    return np.abs(difference) / np.diag(full.static_compliance())


def _rest(housing: ModalHousing, common: set[float], frequency_hz: np.ndarray) -> np.ndarray:
    """Drive-point receptance of the oscillators that are not common [m/N], (f, 12)."""
    own = np.array([f not in common for f in housing.frequency_hz])
    squares = (2.0 * math.pi * housing.frequency_hz[own]) ** 2
    stiffness = squares - (2.0 * math.pi * frequency_hz[:, None]) ** 2
    return (1.0 / stiffness) @ (housing.seat_shapes[:, own] ** 2).T

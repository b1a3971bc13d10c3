"""How wrong the receptance of a housing with few modes can be, and how many modes that takes.

The kept modes reach up to w_n; residual attachment modes carry the rest of the static compliance
(see `reduction`). Without damping, let D = G - sum phi phi^T / w^2 be what the residual vectors
carry, and r = f / f_(n+1) < 1. The exact remainder and that of the pseudo modes are power series in
(2 pi f)^2 whose coefficients at direction i lie between 0 and D_ii / w_(n+1)^(2 k), because no Ritz
value lies below w_(n+1). A Galerkin projection on K^-1 B agrees in the coefficients k = 0 and 1.
Hence

    |error_ii| <= D_ii r^4 / (1 - r^2),   |error_ij| <= sqrt of the product of the bounds of ii, jj

the latter since the error is positive semidefinite.

Source: Z. Bai, Appl. Numer. Math. 43 (2002) 9-44 (moments that a projection matches).
"""

import math
from typing import Any

import numpy as np

from herringbone.housing.files.validation import BAND_OF_MODES


def receptance_bound(
    missing: np.ndarray, frequency_hz: float | np.ndarray, next_frequency_hz: float
) -> np.ndarray:
    """Bound of the error at drive points [m/N], see the module.

    Args:
        missing: (12,) diagonal of D, what the kept modes miss of the static compliance [m/N].
        frequency_hz: frequency [Hz]; the bound is infinite at and above `next_frequency_hz`.
        next_frequency_hz: first mode that is not kept [Hz].
    """
    square = (np.asarray(frequency_hz) / next_frequency_hz) ** 2
    growth = np.divide(
        square**2, 1.0 - square, out=np.full_like(square, np.inf), where=square < 1.0
    )
    return np.multiply.outer(growth, missing)


def choose_modes(
    frequency_hz: np.ndarray,
    seat_shapes: np.ndarray,
    static: np.ndarray,
    band_hz: float,
    tolerance: float,
) -> tuple[int, float] | None:
    """The least number of modes that certifies a tolerance.

    All modes up to 1.5 times the band are kept in any case: the bound speaks of the seats only,
    not of sensors and surfaces.

    Args:
        frequency_hz: (n,) of known modes, lowest first, none left out between them [Hz].
        seat_shapes: (12, n) [kg^-1/2].
        static: (12, 12) exact static compliance [m/N].
        band_hz: highest frequency of interest [Hz].
        tolerance: of the receptance at the seats, relative to the static compliance.

    Returns:
        Number of modes and bound; None if more modes have to be known.
    """
    carried = (seat_shapes / (2.0 * math.pi * frequency_hz)) ** 2
    compliance = np.diag(static)
    first = int(np.searchsorted(frequency_hz, BAND_OF_MODES * band_hz, side="right"))
    for n in range(first, frequency_hz.size):
        missing = np.maximum(compliance - carried[:, :n].sum(axis=1), 0.0)
        bound = float((receptance_bound(missing, band_hz, frequency_hz[n]) / compliance).max())
        if bound <= tolerance:
            return n, bound
    return None


def make_certificate(
    against: str, band_hz: float, tolerance: float, bound: float, kept: int, next_hz: float | None
) -> dict[str, Any]:
    """The figures of a reduction, as they stand in the data file; no next mode if all are kept."""
    return {
        "against": against,
        "quantity": "receptance at the 12 seat directions, relative to static compliance, undamped",
        "band_hz": band_hz,
        "tolerance": tolerance,
        "error_bound": bound,
        "normal_modes": kept,
        "next_frequency_hz": next_hz,
    }

"""Residual attachment modes: what kept modes miss of the static response; see `reduce`."""

import math

import numpy as np
import scipy.linalg as la

from herringbone.housing.reduction.held_model import HeldModel

_NEGLIGIBLE = 1e-11
"""Share of the residual compliance below which a residual vector is rounding."""


def residual_modes(
    model: HeldModel, attachment: np.ndarray, vectors: np.ndarray, omega: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Pseudo modes that carry what the kept modes miss of the static response.

    Args:
        model: of N unknowns.
        attachment: (N, 12) its static response to the seat forces.
        vectors, omega: kept modes (N, n), mass-normalised, and their angular frequencies [rad/s].

    Returns:
        Shapes (N, k), mass-normalised, and frequencies (k,) [Hz]; k <= 12.
    """
    stiffness, mass, seats = model
    if vectors.shape[1] == vectors.shape[0]:
        return np.empty((vectors.shape[0], 0)), np.empty(0)
    missing = attachment - vectors @ ((vectors.T @ seats) / omega[:, None] ** 2)
    missing -= vectors @ (vectors.T @ (mass @ missing))  # rounding of the subtraction
    compliance = missing.T @ (stiffness @ missing)
    size = np.sqrt(np.diag(compliance))
    missing = missing[:, size > 0.0] / size[size > 0.0]
    share, directions = la.eigh(missing.T @ (stiffness @ missing))
    carried = share > _NEGLIGIBLE
    # K-normalised first: the light directions keep their digits.
    basis = missing @ (directions[:, carried] / np.sqrt(share[carried]))
    inverse_squares, turn = la.eigh(basis.T @ (mass @ basis))
    shapes = (basis @ turn / np.sqrt(inverse_squares))[:, ::-1]
    return shapes, (1.0 / (2.0 * math.pi * np.sqrt(inverse_squares)))[::-1]

"""The largest eigenvalue of linear equations whose eigenvalues are known."""

import math

import numpy as np
import pytest

from herringbone.kernels.compiling.jit import kernel
from herringbone.kernels.spectral_radius import radius_scratch, spectral_radius

SLOW, FAST, ZETA = 10.0, 3000.0, 0.02
SIZES = (1e-6, 1e-6, 1e-3, 1e-3)


@kernel
def oscillators(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    """Two oscillators; the second one hangs on the first one's position."""
    dx[0], dx[1] = b[2], b[3]
    dx[2] = 5.0 - SLOW * (SLOW * b[0] + 2.0 * ZETA * b[2])
    dx[3] = -FAST * (FAST * (b[1] - 0.5 * b[0]) + 2.0 * ZETA * b[3])


@kernel
def at_rest(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    for i in range(4):
        dx[i] = 3.0


@kernel
def fails(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    for i in range(4):
        dx[i] = math.inf


def radius_of(rhs):
    b = np.zeros(4 + radius_scratch(4))
    b[:4] = before = np.array([1e-5, -2e-5, 3e-3, 4e-3])
    found = spectral_radius(rhs, SIZES, 4, "test")(b, 0.0)
    assert np.array_equal(b[:4], before)
    return found


def test_the_fastest_oscillator():
    """Two applications at a time turn a conjugate pair by 2 asin(zeta): sixteen average that."""
    assert radius_of(oscillators) == pytest.approx(FAST, rel=0.03)


def test_nothing_to_find():
    assert radius_of(at_rest) == 0.0
    assert not math.isfinite(radius_of(fails))

"""Periodic spline slopes against scipy; Hermite cubics; monotone slopes."""

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from herringbone.kernels.splines import hermite, monotone_slopes, periodic_slopes


@pytest.mark.parametrize("count", [3, 4, 5, 16, 64, 128])
@pytest.mark.parametrize(("at", "stride"), [(0, 1), (5, 3)])
def test_periodic_slopes_are_those_of_scipy(count, at, stride):
    y = np.random.default_rng(count).standard_normal(count)
    values, slopes = np.zeros((2, at + stride * count))
    values[at::stride] = y
    periodic_slopes(values, at, stride, count, slopes, at)
    spline = CubicSpline(np.arange(count + 1), np.append(y, y[0]), bc_type="periodic")
    # The condition of the cyclic system [1 4 1] is 3; values are of size 1.
    np.testing.assert_allclose(
        slopes[at::stride], spline.derivative()(np.arange(count)), atol=1e-13
    )


def test_hermite_is_exact_for_cubics():
    cubic = Polynomial([2.0, -1.0, 3.0, 5.0])
    d = cubic.deriv()
    for f in (0.0, 0.25, 0.5, 1.0):  # dyadic: no rounding
        assert hermite(f, cubic(0), cubic(1), d(0), d(1)) == (cubic(f), d(f))


@pytest.mark.parametrize("seed", range(20))
def test_monotone_slopes_do_not_overshoot(seed):
    random = np.random.default_rng(seed)
    x, y = np.cumsum(random.exponential(1.0, (2, 12)) ** 3, axis=1)  # steps over decades
    slopes = np.zeros(12)
    monotone_slopes(x, y, 12, slopes)
    rates = CubicHermiteSpline(x, y, slopes).derivative()(np.linspace(x[0], x[-1], 20001))
    assert rates.min() >= -1e-12 * np.abs(rates).max()  # rounding
    assert slopes[0] == 0.0
    assert slopes[-1] == pytest.approx((y[-1] - y[-2]) / (x[-1] - x[-2]), rel=1e-15)


def test_monotone_slopes_vanish_at_an_extremum():
    slopes = np.ones(4)
    monotone_slopes(np.arange(4.0), np.array([0.0, 1.0, 0.5, 2.0]), 4, slopes)
    assert slopes[1] == slopes[2] == 0.0


def test_monotone_slopes_are_the_harmonic_mean():
    slopes = np.zeros(3)
    monotone_slopes(np.array([0.0, 1.0, 3.0]), np.array([0.0, 1.0, 7.0]), 3, slopes)
    # Fritsch and Butland: h = 1, 2; secants 1, 3: weights (5, 4)
    assert slopes[1] == pytest.approx(9 / (5 / 1 + 4 / 3), rel=1e-15)

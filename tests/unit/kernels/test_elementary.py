"""Elementary functions within 1 ulp, against numpy's extended precision."""

import math

import numpy as np
import pytest

from herringbone.kernels.elementary import cosine, exponential, sine, sine_and_cosine

needs_extended = pytest.mark.skipif(
    np.finfo(np.longdouble).nmant <= 52, reason="no extended precision on this platform"
)
RANDOM = np.random.default_rng(1)
# Multiples of pi/2 are the hard cases: there the argument reduction cancels.
ANGLES = np.concatenate(
    [
        RANDOM.uniform(-1e6, 1e6, 4000),
        RANDOM.uniform(-4.0, 4.0, 4000),
        RANDOM.integers(-636619, 636619, 4000) * (math.pi / 2),
        np.arange(-400, 401) * (math.pi / 4),
        np.logspace(-300, 0, 200),
    ]
)
EXPONENTS = np.concatenate(
    [RANDOM.uniform(-708.0, 709.0, 6000), RANDOM.uniform(-1, 1, 2000), [-708.0, 709.0, 1e-300]]
)


def worst_ulp(function, reference, points: np.ndarray) -> float:
    exact = reference(points.astype(np.longdouble))
    found = np.array([function(x) for x in points.tolist()])
    return float((np.abs(found - exact) / np.spacing(np.abs(exact.astype(float)))).max())


@needs_extended
@pytest.mark.parametrize(
    ("function", "reference", "points"),
    [(sine, np.sin, ANGLES), (cosine, np.cos, ANGLES), (exponential, np.exp, EXPONENTS)],
)
def test_error_is_at_most_one_ulp(function, reference, points):
    assert worst_ulp(function, reference, points) <= 1.0  # the docstring's claim


def test_sine_and_cosine_together_have_the_same_bits():
    points = ANGLES.tolist()
    assert [sine_and_cosine(x) for x in points] == [(sine(x), cosine(x)) for x in points]


def test_exact_values():
    assert (sine(0.0), cosine(0.0), exponential(0.0)) == (0.0, 1.0, 1.0)


@pytest.mark.parametrize(("x", "value"), [(-708.1, 0.0), (-1e300, 0.0), (709.1, math.inf)])
def test_exponential_outside_its_range(x, value):
    assert exponential(x) == value


@pytest.mark.parametrize("function", [sine, cosine, exponential])
def test_nan_stays_nan(function):
    assert math.isnan(function(math.nan))

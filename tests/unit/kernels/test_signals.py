"""Polynomial signals: coefficients from nodes, evaluation, re-expansion."""

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from herringbone.kernels.signals import STRIDE, all_finite, evaluate, monomial, shift, store_node

DEGREES = range(5)


def polynomial(degree: int) -> np.ndarray:
    """Coefficients for which the values at the nodes i / degree are exact numbers."""
    return np.array([7.0, -3.0, 5.0, -2.0, 11.0][: degree + 1]) * max(degree, 1) ** degree


def nodes(coefficients: np.ndarray) -> np.ndarray:
    """Values at the nodes, in a longer array: what lies around them must not matter."""
    degree = coefficients.size - 1
    c = np.arange(degree + 1) / max(degree, 1)
    values = np.full(3 + STRIDE, np.nan)
    values[3 : 3 + degree + 1] = np.rint(Polynomial(coefficients)(c) * 256) / 256
    return values


@pytest.mark.parametrize("degree", DEGREES)
def test_monomial_is_exact(degree):
    # All intermediate numbers have few bits, so that there is no rounding: equality to the bit.
    expected = polynomial(degree)
    out = np.full(2 + STRIDE, 99.0)
    monomial(nodes(expected), 3, degree, out, 2)
    np.testing.assert_array_equal(out[2 : 2 + degree + 1], expected)
    assert not out[2 + degree + 1 :].any()
    np.testing.assert_array_equal(out[:2], 99.0)


@pytest.mark.parametrize("degree", DEGREES)
def test_signal_passes_through_its_nodes(degree):
    values = np.random.default_rng(degree).standard_normal(STRIDE)
    out = np.zeros(STRIDE)
    monomial(values, 0, degree, out, 0)
    found = [evaluate(out, 0, degree, i / max(degree, 1)) for i in range(degree + 1)]
    # The coefficients of degree 4 are at most 683 times the values (sum of |Lagrange| rows).
    np.testing.assert_allclose(found, values[: degree + 1], atol=700 * 4 * 2.3e-16)


@pytest.mark.parametrize("degree", DEGREES)
@pytest.mark.parametrize("c", [0.0, 0.375, 1.0, 1.75])
def test_evaluate_is_exact(degree, c):
    coefficients = polynomial(degree)
    padded = np.concatenate([[np.nan], coefficients, [np.nan]])
    assert evaluate(padded, 1, degree, c) == Polynomial(coefficients)(c)


@pytest.mark.parametrize("degree", DEGREES)
@pytest.mark.parametrize(("start", "width"), [(0.0, 1.0), (0.25, 0.25), (0.5, 0.5), (0.75, 0.25)])
def test_shift_is_exact(degree, start, width):
    coefficients = np.concatenate([[np.nan], polynomial(degree), [np.nan]])
    expected = Polynomial(polynomial(degree))(Polynomial([start, width])).coef
    shift(coefficients, 1, degree, start, width)
    np.testing.assert_array_equal(coefficients[1:-1], np.resize(expected, degree + 1))
    assert np.isnan(coefficients[[0, -1]]).all()


def test_store_node_writes_that_node_only():
    block = np.arange(4.0 * STRIDE)
    store_node(block, STRIDE, 2, 3)
    expected = np.arange(4.0 * STRIDE)
    expected[STRIDE + 3], expected[2 * STRIDE + 3] = STRIDE, 2 * STRIDE
    np.testing.assert_array_equal(block, expected)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_all_finite_looks_at_its_range_only(bad):
    block = np.zeros(5)
    block[3] = bad
    assert all_finite(block, 0, 3)
    assert not all_finite(block, 0, 4)

"""The polynomial of the forces on a slow body: nearest in the mean square, with the same mean."""

import numpy as np
import pytest

from herringbone.cosim.layouts.slow import fit_matrix

CASES = [(2, 2), (5, 4), (15, 4), (6, 1), (9, 0)]


@pytest.mark.parametrize(("samples", "degree"), CASES)
def test_polynomials_are_found_again(samples, degree):
    c = np.linspace(0.0, 1.0, samples + 1)
    nodes = np.arange(degree + 1) / degree if degree else np.array([0.5])
    for power in range(degree + 1):
        assert fit_matrix(samples, degree) @ c**power == pytest.approx(nodes**power, abs=1e-12)


@pytest.mark.parametrize(("samples", "degree"), CASES)
def test_mean_and_first_moment_are_kept(samples, degree):
    """Of any samples, by the trapezoidal rule; the first moment from degree 1 on."""
    values = np.random.default_rng(0).standard_normal(samples + 1)
    c = np.linspace(0.0, 1.0, samples + 1)
    nodes = np.arange(degree + 1) / degree if degree else np.array([0.5])
    fitted = np.polynomial.Polynomial.fit(nodes, fit_matrix(samples, degree) @ values, degree)
    for power in range(min(degree, 1) + 1):
        wanted = np.trapezoid(c**power * values, c)
        assert np.trapezoid(c**power * fitted(c), c) == pytest.approx(wanted, abs=1e-12)

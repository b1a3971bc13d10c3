"""Integrals of exponentials times powers, against quadrature."""

import numpy as np
import pytest

from herringbone.kernels.condensed.in_block.condensing.of_mode import powers

NODES, WEIGHTS = np.polynomial.legendre.leggauss(60)


@pytest.mark.parametrize("rate", [0.0, -1e-9, 0.3j, -0.7 + 0.7j, -1.2, -0.1 + 1.1j, -2.0 + 8.0j])
@pytest.mark.parametrize("t", [1.0, 2.5e-5])
def test_powers(rate, t):
    """Quadrature is exact to rounding: exponents turn by 8 rad at most."""
    z, count = rate / t, 6
    real, imag = np.zeros(count + 1), np.zeros(count + 1)
    powers(z.real, z.imag, t, count, real, imag)
    s = 0.5 * (NODES + 1.0)
    for j in range(count):
        expected = 0.5 * t * np.sum(WEIGHTS * np.exp(z * t * (1.0 - s)) * s**j)
        assert real[j] + 1j * imag[j] == pytest.approx(expected, abs=1e-13 * t)
    assert real[count] + 1j * imag[count] == pytest.approx(np.exp(rate), abs=1e-14)

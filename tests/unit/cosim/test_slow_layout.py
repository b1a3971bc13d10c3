"""Slow bodies: the polynomial of the forces on one, nearest in the mean square, with the same mean;
and their outputs.
"""

from dataclasses import replace

import numpy as np
import pytest
from support.parts.two_masses import TWO_MASS_SYSTEM, TwoMass

from herringbone.cosim.algorithms import Predict
from herringbone.cosim.layouts.layout import connected_outputs
from herringbone.cosim.layouts.slow import fit_matrix
from herringbone.cosim.structure.network import build_network

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


def test_outputs_are_read_once():
    """The right mass has its velocity connected, which is the rate of its position, too."""
    network = build_network(TWO_MASS_SYSTEM, TwoMass().parts(acceleration=True))
    slow = replace(network, slow={1: 5})
    assert connected_outputs(slow)[1] == ["flange.s", "flange.v", "flange.a"]
    assert connected_outputs(network)[1] == ["flange.s", "flange.v"]
    prepared = Predict().prepare(slow)  # has arrays for each name; nobody asks it to step slow ones
    assert prepared.layout.output_reference.size == prepared._prediction.rate.size

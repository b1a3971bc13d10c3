"""Loops are compiled without FMI derivatives where all parts have signal nodes."""

import pytest
from support.derivatives import DerivativeMass
from support.parts.two_masses import TWO_MASS_SYSTEM, Mass, TwoMass

from herringbone.cosim.algorithms import LI, GaussSeidel, Jacobi
from herringbone.cosim.structure.network import build_network

ALGORITHMS = [LI(degree=3), Jacobi(1), GaussSeidel(1)]


@pytest.mark.parametrize("algorithm", ALGORITHMS, ids=str)
@pytest.mark.parametrize(("kind", "order"), [(Mass, None), (DerivativeMass, {"li": 3})])
def test_derivatives_are_laid_out_for_parts_that_need_them(algorithm, kind, order):
    prepared = algorithm.prepare(build_network(TWO_MASS_SYSTEM, TwoMass().parts(kind=kind)))
    signals = prepared.layout.derivatives
    if order is None:
        assert signals is None
    else:
        assert signals.order.tolist() == [order.get(algorithm.name, 1), 0, 0]


def test_a_held_part_needs_the_mean_of_its_inputs():
    """li holds the inputs of a part without nodes at their mean, which is a fit as well."""
    prepared = LI(degree=2).prepare(build_network(TWO_MASS_SYSTEM, TwoMass().parts(nodes=False)))
    assert prepared.layout.derivatives.order.tolist() == [0, 0, 0]
    assert prepared.layout.derivatives.fit[0, 0] == pytest.approx([1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0])

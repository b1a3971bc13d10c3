"""Every algorithm converges with the order that it declares, and says so to what it lays out."""

from support.algorithms import DRIVEN, PROBLEM, Ramp, check_order, every, keeps_its_step

from herringbone.cosim.structure.network import build_network


@every(keeps_its_step)
def test_order(algorithm):
    check_order(algorithm)


@every()
def test_downgrades_are_told_from_the_declared_order(algorithm):
    parts = [*PROBLEM.parts(acceleration=True), Ramp("ramp", 1.0)]
    prepared = algorithm.prepare(build_network(DRIVEN, parts))
    assert prepared.full_order == algorithm.convergence_order

"""Naming algorithms, their options, and what they lay out."""

import re

import pytest
from support.parts.fakes import FakePart
from support.parts.two_masses import TWO_MASS_SYSTEM, Mass, SpringDamper, TwoMass

from herringbone.core import ParameterError
from herringbone.core.part import Addresses
from herringbone.cosim.algorithms import GaussSeidel, Jacobi, parse_algorithm
from herringbone.cosim.structure.network import build_network
from herringbone.cosim.structure.system import PartSpec, System


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("jacobi", Jacobi()),
        ("jacobi:", Jacobi()),
        ("jacobi:order=0", Jacobi(order=0)),
        ("jacobi:order=1,schedule=parallel", Jacobi(order=1, schedule="parallel")),
        ("jacobi:schedule=bodies_first", Jacobi()),
        ("gauss_seidel", GaussSeidel()),
        ("gauss_seidel:order=1", GaussSeidel(order=1)),
    ],
)
def test_parse(text, expected):
    assert parse_algorithm(text) == expected


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "there is no algorithm ''; there are: auto, jacobi, gauss_seidel"),
        ("newton", "there is no algorithm 'newton'; there are: "),
        ("Jacobi", "there is no algorithm 'Jacobi'"),
        ("jacobi:degree=2", "jacobi has no option 'degree'; it has: order, schedule"),
        ("jacobi:order", "jacobi:order: it must be a whole number, 0, 1 or 2"),
        ("jacobi:order=two", "jacobi:order=two: it must be a whole number, 0, 1 or 2"),
        ("jacobi:order=1.5", "jacobi:order=1.5: it must be a whole number, 0, 1 or 2"),
        ("jacobi:order=3", "jacobi: order=3; it must be 0, 1 or 2"),
        ("jacobi:order=-1", "jacobi: order=-1; it must be 0, 1 or 2"),
        ("jacobi:schedule=fast", "jacobi: schedule=fast; it must be bodies_first or parallel"),
        ("gauss_seidel:order=0", "gauss_seidel: order=0; it must be 1 or 2"),
        ("gauss_seidel:schedule=parallel", "gauss_seidel has no option 'schedule'; it has: order"),
        ("predict:order=2", "predict has no option 'order'; it has none"),
        ("li:degree=2.5", "li:degree=2.5: it must be a whole number, 1, 2, 3 or 4; the default is"),
        ("li:degree", "li:degree: it must be a whole number, 1, 2, 3 or 4; the default is li:degr"),
        ("li:tolerance=x", "li:tolerance=x: it must be a number, between 1e-08 and 1, or 0 for"),
    ],
)
def test_parse_refuses(text, message):
    with pytest.raises(ParameterError, match=re.escape(message)):
        parse_algorithm(text)


def test_an_option_given_twice_is_refused():
    with pytest.raises(ParameterError, match="order"):
        parse_algorithm("jacobi:order=1,order=2")


def two_mass(nodes=True):
    return build_network(TWO_MASS_SYSTEM, TwoMass().parts(nodes=nodes))


@pytest.mark.parametrize(
    "algorithm", [Jacobi(0), Jacobi(1), Jacobi(2), GaussSeidel(1), GaussSeidel(2)], ids=str
)
def test_bodies_get_as_many_nodes_as_the_order(algorithm):
    prepared = algorithm.prepare(two_mass())
    assert prepared.degree == (algorithm.order, algorithm.order, 0)
    assert prepared.notes == ()


@pytest.mark.parametrize("algorithm", [Jacobi(1), Jacobi(2), GaussSeidel(1)], ids=str)
def test_downgrade_without_nodes_is_noted(algorithm):
    prepared = algorithm.prepare(two_mass(nodes=False))
    assert prepared.degree == (0, 0, 0)
    assert prepared.notes == tuple(
        f"{name} takes no signal nodes: its inputs are held over a step, "
        "which makes the coupling first order in the step"
        for name in ("left", "right")
    )


def test_order_0_needs_no_nodes():
    assert Jacobi(order=0).prepare(two_mass(nodes=False)).notes == ()


def test_only_the_part_without_nodes_is_downgraded():
    parts = [Mass("left", 1.0), Mass("right", 1.0, nodes=False), SpringDamper("spring", 1.0, 0.0)]
    prepared = Jacobi(order=2).prepare(build_network(TWO_MASS_SYSTEM, parts))
    assert prepared.degree == (2, 0, 0)
    assert len(prepared.notes) == 1 and prepared.notes[0].startswith("right ")


def stages(prepared):
    layout = prepared.layout
    return [
        layout.stage_part[a:b].tolist()
        for a, b in zip(layout.stage_first[:-1], layout.stage_first[1:], strict=True)
    ]


def test_stages_of_two_masses():
    network = two_mass()
    assert stages(Jacobi(2).prepare(network)) == [[0, 1], [2]]
    assert stages(Jacobi(2, "parallel").prepare(network)) == [[0, 1, 2]]
    assert stages(GaussSeidel(2).prepare(network)) == [[0], [2], [1]]


def test_gauss_seidel_steps_every_part_once():
    """A chain of three masses: each spring comes between the two masses that it joins."""
    parts = [
        Mass("a", 1.0), Mass("b", 1.0), Mass("c", 1.0),
        SpringDamper("ab", 1.0, 0.0), SpringDamper("bc", 1.0, 0.0),
    ]  # fmt: skip
    wires = (("b.flange", "ab.b"), ("a.flange", "ab.a"), ("c.flange", "bc.b"))
    extra = (("b.flange.s", "bc.a.s"), ("b.flange.v", "bc.a.v"))
    system = System("chain", "", tuple(PartSpec(p.name) for p in parts), (*wires, *extra))
    found = stages(GaussSeidel(2).prepare(build_network(system, parts)))
    assert found == [[0], [3], [1], [4], [2]]


def test_sources_come_first():
    source = FakePart("source").real("y", "output", "N")
    source.addresses = Addresses(0, 0, 0, 0)
    parts = [Mass("m", 1.0), source]
    system = System("driven", "", tuple(PartSpec(p.name) for p in parts), (
        ("source.y", "m.flange.f"),
    ))  # fmt: skip
    network = build_network(system, parts)
    assert stages(Jacobi(2).prepare(network)) == [[1], [0]]
    assert stages(GaussSeidel(2).prepare(network)) == [[1], [0]]

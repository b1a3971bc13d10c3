"""Which parts a change of an unknown reaches, and that the others need not step."""

import numpy as np
import pytest
from support.parts.fakes import OK, CallbackPart
from support.parts.two_masses import Mass, SpringDamper

from herringbone.cosim.algorithms import LI
from herringbone.cosim.layouts.reach import reach_of
from herringbone.cosim.simulation import make_grid, ready
from herringbone.cosim.structure.network import build_network
from herringbone.cosim.structure.system import PartSpec, System

NAMES = ("left", "right", "far", "near", "away", "twice")
CHAIN = System(
    "chain", "", tuple(map(PartSpec, NAMES)),
    (
        ("left.flange", "near.a"), ("right.flange", "near.b"), ("far.flange", "away.b"),
        ("right.flange.s", "away.a.s"), ("right.flange.v", "away.a.v"),
        ("away.a.f", "right.load.f"), ("near.b.f", "twice.u.f"), ("twice.y.f", "far.load.f"),
    ),
)  # fmt: skip
"""Three masses in a row; what the first spring does to the second acts on the third, doubled."""


class Twice(CallbackPart):
    """An element: y = 2 u."""

    feedthrough = True

    def __init__(self):
        super().__init__("twice", ["u.f"], ["y.f"])

    def out(self):
        self["y.f"] = 2.0 * self["u.f"]

    def step(self, t, h):
        self.write("y.f", 2.0 * np.asarray(self.nodal("u.f")[min(1, self.degree) :]))
        return OK


def parts():
    masses = [Mass("left", 1.0, 0.3), Mass("right", 2.0), Mass("far", 3.0)]
    springs = [SpringDamper("near", 5.0, 0.2), SpringDamper("away", 7.0, 0.1)]
    return [*masses, *springs, Twice()]


@pytest.fixture(scope="module")
def prepared():
    return LI(degree=2).prepare(build_network(CHAIN, parts()))


def test_a_body_and_the_elements_behind_it(prepared):
    """A force on the first mass moves the first spring alone, and what doubles its force."""
    reach, network = reach_of(prepared.layout, prepared.nodes), prepared.network
    owners = [f"{network.parts[p].name}.{name}" for p, name in prepared.jacobian.owners]
    seen = {
        owners[unknown]: {network.parts[p].name for p in np.flatnonzero(reach.sees[i])}
        for i, unknown in enumerate(prepared.nodes.unknown)
    }
    assert seen == {
        "near.a.f": {"left", "near", "twice"},
        "near.b.f": {"right", "near", "away", "twice"},
        "away.a.f": {"right", "near", "away", "twice"},
        "away.b.f": {"far", "away"},
        "twice.y.f": {"far", "away"},
    }
    bodies = [network.parts[p].name for p in reach.body]
    assert bodies == ["left", "right", "far", "right", "far"]
    assert reach.body_first.tolist() == [0, 1, 2, 3, 4, 5]


def test_the_jacobian_is_that_of_the_whole_network(monkeypatch):
    """To the last bit that of passes in which all parts step; 17 forces change by one of 5."""
    found = [jacobian_of_chain()]
    monkeypatch.setattr("herringbone.cosim.algorithms.jacobian.reach_of", all_parts)
    found.append(jacobian_of_chain())
    assert np.array_equal(*found)
    assert np.count_nonzero(np.abs(found[0]) > 1e-9) == 17 * 2 * 2  # at two nodes each


def all_parts(layout, nodes):
    """The reach of a network in which everything sees everything."""
    reach = reach_of(layout, nodes)
    count = nodes.unknown.size
    return reach._replace(
        sees=np.ones_like(reach.sees),
        body_first=np.arange(count + 1) * nodes.bodies.size,
        body=np.tile(nodes.bodies, count),
    )


def jacobian_of_chain():
    run, _ = ready(CHAIN, parts(), LI(degree=2), make_grid(0.1, 0.05, 0.05))
    run.go(None)
    return run.prepared.measured(0.05, 0.05, 2)

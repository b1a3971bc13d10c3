"""How a system's parts follow from its connections: bodies, elements, orders, loops."""

from dataclasses import replace

import pytest
from support.parts.fakes import FakePart
from support.parts.networks import mass, network, passing, refused, spring

from herringbone.core import ParameterError
from herringbone.cosim.algorithms import GaussSeidel, Predict


def test_classes_of_parts():
    source = FakePart("source").real("y", "output", "N")
    parts = [spring(), mass("m"), source, mass("n")]
    found = network(parts, ("m.flange", "spring.a"), ("spring.b", "n.flange"))
    assert (found.elements, found.bodies, found.sources) == ((0,), (1, 3), (2,))


def test_two_sources_on_one_input():
    parts = [passing("p"), passing("q"), passing("r")]
    refused("input 'r.u' has two sources: 'p.y' and 'q.y'", parts, ("p.y", "r.u"), ("q.y", "r.u"))


def test_one_output_may_feed_many():
    parts = [passing("p"), passing("q"), passing("r")]
    assert len(network(parts, ("p.y", "q.u"), ("p.y", "r.u")).connections) == 2


def test_body_to_body():
    said = refused("insert a shaft coupling", [mass("m"), mass("n")], ("m.flange", "n.flange"))
    assert "'m.flange' - 'n.flange'" in said


def test_unmatched_input():
    other = FakePart("other").real("a.s", "output", "m").real("a.f", "input", "N")
    pair = ("spring.b", "other.a")
    said = refused("finds no output 'v' at the other port", [spring(), other], pair)
    assert "'spring.b.v'" in said


def test_algebraic_loop_is_named():
    parts = [passing("p"), passing("q"), mass("m")]
    said = refused("algebraic loop: ", parts, ("p.y", "q.u"), ("q.y", "p.u"))
    loop = said.removeprefix("algebraic loop: ").split(";")[0].split(" -> ")
    assert loop[0] == loop[-1] and set(loop) == {"p", "q"}
    assert "put a body" in said


def test_element_to_element_asks_for_a_body():
    said = refused("'p.a' - 'q.a'", [spring("p"), spring("q")], ("p.a", "q.a"))
    assert "put a body" in said and "shaft_coupling" not in said


def test_elements_are_ordered_as_they_feed_each_other():
    sink = FakePart("sink").real("u", "input").real("x", "output")
    source = FakePart("s").real("y", "output")
    parts = [passing("c"), sink, passing("b"), passing("a"), source]
    pairs = ("c.y", "sink.u"), ("b.y", "c.u"), ("a.y", "b.u"), ("s.y", "a.u")
    found = network(parts, *pairs)
    assert [parts[i].name for i in found.elements] == ["a", "b", "c"]


def body_and_element(name):
    """Motion x moves under force f; reaction r is a direct answer to seat motion q."""
    return (
        FakePart(name).real("f", "input", "N").real("q", "input", "m")
        .real("x", "output", "m", frozenset()).real("r", "output", "N", frozenset({"q"}))
    )  # fmt: skip


def test_a_part_may_be_body_and_element_at_once():
    link = FakePart("link").real("x", "input", "m").real("f", "output", "N", frozenset({"x"}))
    seat = FakePart("seat").real("r", "input", "N").real("q", "output", "m", frozenset())
    parts = [link, body_and_element("box"), seat]
    pairs = (("box.x", "link.x"), ("link.f", "box.f"), ("seat.q", "box.q"), ("box.r", "seat.r"))
    found = network(parts, *pairs)
    assert (found.elements, found.bodies, found.mixed) == ((1, 0), (2,), {1})
    for algorithm in (GaussSeidel(), Predict()):
        with pytest.raises(ParameterError, match=r"box is body and element at once .*; use li"):
            algorithm.prepare(found)


def yielding(name):
    """A body that gives way directly under its force."""
    return (
        FakePart(name).real("a.f", "input", "N").real("a.s", "output", "m", frozenset({"a.f"}))
        .real("a.v", "output", "m/s", frozenset())
    )  # fmt: skip


def test_loop_is_cut_at_the_force_on_a_body():
    parts = [spring(), yielding("seat"), mass("m")]
    found = network(parts, ("seat.a", "spring.a"), ("m.flange", "spring.b"))
    assert (found.elements, found.bodies) == ((0,), (1, 2))
    assert (found.feedthrough, found.mixed) == ({1}, frozenset())
    with pytest.raises(ParameterError, match="seat has direct feedthrough"):
        found.with_slow({"seat": 2})


def undeclared(name):
    part = FakePart(name).real("u", "input").real("y", "output")
    part.variables["y"] = type(part.variables["y"])("y", 1, "output", "1", dependencies=None)
    return part


def test_undeclared_dependencies_count_as_an_element():
    source = FakePart("s").real("y", "output")
    parts = [undeclared("p"), source, passing("q")]
    found = network(parts, ("s.y", "p.u"), ("p.y", "q.u"))
    assert 0 in found.elements
    assert "p declares no output dependencies; taken as an element" in found.notes


def test_a_mass_that_declares_no_dependencies_is_a_body():
    """It takes a force and gives the motion of that port, also where no circle shows it."""
    part = mass("p")
    for name, v in part.variables.items():
        if v.causality == "output":
            part.variables[name] = replace(v, dependencies=None)
    source = FakePart("s").real("y", "output", "N")
    ends = ("s.y", "p.flange.f"), ("p.flange.s", "q.u")
    found = network([part, source, passing("q", "m")], *ends)
    assert (found.elements, found.bodies) == ((2,), (0,))
    assert "p declares no output dependencies; taken as a body" in found.notes


def test_undeclared_dependencies_in_a_circle_make_a_body():
    found = network([undeclared("p"), passing("q")], ("p.y", "q.u"), ("q.y", "p.u"))
    assert (found.elements, found.bodies) == ((1,), (0,))
    assert found.notes == ("p declares no output dependencies; taken as a body",)

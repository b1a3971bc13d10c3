"""Every check of a connection's ends, units and types, with its message."""

import math

import pytest
from support.parts.fakes import FakePart
from support.parts.networks import mass, network, passing, refused, spring

from herringbone.core.part import PartVariable
from herringbone.cosim.structure.units import unit_conversion


def test_ports_pair_outputs_and_inputs_by_suffix():
    found = network([mass("m"), spring()], ("m.flange", "spring.a"))
    pairs = {(c.source, c.output, c.target, c.input) for c in found.connections}
    assert pairs == {
        (0, "flange.s", 1, "a.s"), (0, "flange.v", 1, "a.v"), (1, "a.f", 0, "flange.f")
    }  # fmt: skip


def test_order_of_a_connections_ends_does_not_matter():
    parts = [mass("m"), spring()]
    one = network(parts, ("m.flange", "spring.a")).connections
    assert set(one) == set(network(parts, ("spring.a", "m.flange")).connections)


def test_unknown_part_names_those_that_exist():
    said = refused("has no part 'gear'", [mass("m"), spring()], ("gear.flange", "spring.a"))
    assert "it has: m, spring" in said


def test_unknown_port_names_those_that_exist():
    said = refused("no variable or port 'left'", [mass("m"), spring()], ("spring.left", "m.flange"))
    assert "it has the ports a, b" in said and "'spring.left'" in said


def test_a_part_without_ports_names_its_variables():
    part = FakePart("p").real("u", "input").real("y", "output").real("k", "parameter")
    said = refused("no variable or port 'left'", [mass("m"), part], ("p.left", "m.flange"))
    assert "it has no ports, and the inputs and outputs u, y; join one of these" in said


def test_path_without_port():
    refused(
        "connection 'm': it must be PART.PORT or PART.VARIABLE",
        [mass("m"), spring()],
        ("m", "spring.a"),
    )


def test_port_against_variable():
    refused(
        "'m.flange' - 'spring.a.s': one is a port, the other is not",
        [mass("m"), spring()], ("m.flange", "spring.a.s"),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("pair", "causality"),
    [(("m.flange.s", "n.flange.s"), "output"), (("m.flange.f", "n.flange.f"), "input")],
)
def test_two_outputs_or_two_inputs(pair, causality):
    said = refused("it must join an output and an input", [mass("m"), mass("n")], pair)
    assert said.count(f"({causality})") == 2
    assert all(f"'{path}'" in said for path in pair)


def test_parameter_cannot_be_connected():
    part = FakePart("p").real("k", "parameter")
    refused("'p.k' (parameter)", [part, passing("q")], ("p.k", "q.u"))


def test_units_differ():
    parts = [FakePart("p").real("y", "output", "N"), FakePart("q").real("u", "input", "N.m")]
    refused("connection 'p.y' -> 'q.u': units differ, 'N' and 'N.m'", parts, ("p.y", "q.u"))


def test_same_unit_under_two_names():
    dimension = (1.0, 0.0, (("kg", 1), ("m", 2), ("s", -2)))
    parts = [
        FakePart("p").real("y", "output", "Nm", dimension=dimension),
        FakePart("q").real("u", "input", "N.m", dimension=dimension),
    ]
    assert not network(parts, ("p.y", "q.u")).notes


def test_units_of_one_dimension_are_converted_by_their_definitions():
    rpm = PartVariable("y", 0, "output", "r/min", (math.pi / 30.0, 0.0, (("rad", 1), ("s", -1))))
    speed = PartVariable("u", 0, "input", "rad/s", (1.0, 0.0, (("rad", 1), ("s", -1))))
    celsius = PartVariable("y", 0, "output", "degC", (1.0, 273.15, (("K", 1),)))
    fahrenheit = PartVariable("u", 0, "input", "degF", (5 / 9, 459.67 * 5 / 9, (("K", 1),)))
    assert unit_conversion(rpm, speed, "") == (math.pi / 30.0, 0.0)
    factor, offset = unit_conversion(celsius, fahrenheit, "")
    assert factor * 100.0 + offset == pytest.approx(212.0, rel=1e-14)


def test_parts_that_are_not_in_si_units_keep_their_conversion():
    si, milli = (1.0, 0.0, (("m", 1),)), (1e-3, 0.0, (("m", 1),))
    parts = [
        FakePart("p").real("y", "output", "m", dimension=si),
        FakePart("q").real("u", "input", "mm", dimension=milli),
    ]
    (found,) = network(parts, ("p.y", "q.u")).connections
    assert (found.factor, found.offset) == (1e3, 0.0)


def test_unit_without_definition_is_refused():
    parts = [
        FakePart("p").real("y", "output", "rpm"),
        FakePart("q").real("u", "input", "rad/s", dimension=(1.0, 0.0, (("rad", 1), ("s", -1)))),
    ]
    refused("'rpm' and 'rad/s', and 'rpm' has no definition by base", parts, ("p.y", "q.u"))


def test_undeclared_unit_is_noted():
    parts = [FakePart("p").real("y", "output", "N"), FakePart("q").real("u", "input", None)]
    (note,) = network(parts, ("p.y", "q.u")).notes
    said = "a unit is not declared, so it was not checked; what has none is taken as SI"
    assert note == f"connection 'p.y' -> 'q.u': {said}"


def test_a_definition_that_is_no_conversion_is_refused():
    nothing = (0.0, 0.0, (("rad", 1), ("s", -1)))
    parts = [
        FakePart("p").real("y", "output", None),
        FakePart("q").real("u", "input", "r/min", type="Float32", dimension=nothing),
    ]
    refused("unit 'r/min' has the factor 0 and the offset 0 to SI", parts, ("p.y", "q.u"))


@pytest.mark.parametrize(("output", "input_"), [("Float32", "Float64"), ("Float32", "Float32")])
def test_single_precision_without_unit_is_taken_as_si(output, input_):
    """As Float64 is: 3000 r/min are 314.16 at an input without unit, and the other way round."""
    rpm = (math.pi / 30.0, 0.0, (("rad", 1), ("s", -1)))
    parts = [
        FakePart("p").real("y", "output", "r/min", type=output, dimension=rpm),
        FakePart("q").real("u", "input", None, type=input_).real("y", "output", None, type=output),
        FakePart("r").real("u", "input", "r/min", type=input_, dimension=rpm),
    ]
    found = network(parts, ("p.y", "q.u"), ("q.y", "r.u"))
    there, back = (c.converted(3000.0) for c in found.others)
    assert there == pytest.approx(100.0 * math.pi, rel=1e-15)
    assert back == pytest.approx(9e4 / math.pi, rel=1e-15)
    assert len(found.notes) == 2


@pytest.mark.parametrize(
    ("output", "input_", "fit"),
    [
        ("Int32", "Int64", True), ("Int64", "Int32", False), ("UInt8", "Int16", True),
        ("UInt16", "Int16", False), ("Int8", "UInt64", False), ("Integer", "Real", True),
        ("Int64", "Float64", False), ("UInt32", "Float64", True), ("Int16", "Float32", True),
        ("Int32", "Float32", False), ("Float32", "Real", True), ("Float64", "Float32", True),
        ("Boolean", "Integer", False), ("Boolean", "Boolean", True), ("String", "String", True),
        ("String", "Binary", False), ("Float64", "Int64", False), ("Enumeration", "Int64", True),
        ("Enumeration", "Int32", False), ("Int32", "Enumeration", False),
    ],
)  # fmt: skip
def test_types_that_lose_nothing_but_digits_can_be_connected(output, input_, fit):
    parts = [
        FakePart("p").real("y", "output", type=output),
        FakePart("q").real("u", "input", type=input_),
    ]
    if fit:
        found = network(parts, ("p.y", "q.u"))
        assert len(found.others) == 1
        assert not found.connections
    else:
        said = f"'p.y' -> 'q.u': {output} does not fit into {input_} without loss"
        refused(said, parts, ("p.y", "q.u"))


def test_enumerations_of_other_items_are_refused():
    gears, modes = (("first", 1), ("second", 2)), (("off", 1), ("on", 2))
    parts = [
        FakePart("p").real("y", "output", type="Enumeration", items=gears),
        FakePart("q").real("u", "input", type="Enumeration", items=modes),
    ]
    refused("without loss, because their items differ", parts, ("p.y", "q.u"))


def vector(name, variable, causality, size):
    part = FakePart(name)
    for k in range(1, size + 1):
        part.real(f"{variable}[{k}]", causality, type="Float64", array=variable)
    return part


def test_arrays_of_one_shape_are_connected_element_by_element():
    parts = [vector("p", "y", "output", 3), vector("q", "u", "input", 3)]
    found = network(parts, ("p.y", "q.u")).connections
    assert [(c.output, c.input) for c in found] == [(f"y[{k}]", f"u[{k}]") for k in (1, 2, 3)]
    found = network(parts, ("p.y[2]", "q.u[1]")).connections
    assert [(c.output, c.input) for c in found] == [("y[2]", "u[1]")]


def test_arrays_of_other_shapes_are_refused():
    parts = [vector("p", "y", "output", 3), vector("q", "u", "input", 2)]
    refused("'p.y' has 3 elements and 'q.u' has 2 elements; arrays of one", parts, ("p.y", "q.u"))

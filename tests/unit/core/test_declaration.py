"""Declarations: what is refused, and the layout of the block."""

import pytest

from herringbone.components.registry import COMPONENTS
from herringbone.core import (
    Declaration,
    StateVector,
    StructureError,
    Text,
    input_,
    local,
    output,
    parameter,
    state,
)
from herringbone.core.declaring.variable import NODES
from herringbone.core.errors import ParameterError
from herringbone.kernels.signals import STRIDE


def declare(*variables, **more) -> Declaration:
    return Declaration("thing", "a thing", variables, **more)


def test_name_twice():
    with pytest.raises(StructureError, match="thing: declared twice: a, b"):
        declare(*(state(n, "m", "") for n in ("b", "a", "c", "a", "b")))


def test_name_of_a_text_twice():
    with pytest.raises(StructureError, match="declared twice: a"):
        declare(state("a", "m", ""), texts=[Text("a", "", "a.csv")])


def test_name_of_a_state_vector_twice():
    with pytest.raises(StructureError, match="declared twice: q"):
        declare(state("q", "m", ""), vectors=[StateVector("q", "m", "", 2)])


def test_unit_of_a_state_vector_must_be_known():
    with pytest.raises(StructureError, match="unit 'kg m' is unknown"):
        declare(vectors=[StateVector("q", "kg m", "", 2)])


@pytest.mark.parametrize(
    ("vector", "element"),
    [("q", "q[3]"), ("a.q", "a.q[3]"), ("der(a.q)", "der(a.q[3])")],
)
def test_element_of_a_state_vector_has_a_structured_name(vector, element):
    """FMI 2.0.4, section 2.2.9: `der(identifier)`, where the identifier has the indices."""
    assert StateVector(vector, "m", "", 4).element(3) == element


def test_interface_degree_is_taken():
    with pytest.raises(StructureError, match="declared twice: interface_degree"):
        declare(parameter("interface_degree", "1", "", 0.0))


def test_unknown_unit_names_the_known_ones():
    with pytest.raises(StructureError, match=r"unit 'mm' is unknown; use one of: 1, s, m, m/s"):
        declare(output("x", "mm", ""))


@pytest.mark.parametrize("cause", ["nothing", "x", "p"])
def test_feedthrough_must_be_from_an_input(cause):
    with pytest.raises(StructureError, match=rf"thing\.y: feedthrough from unknown {{'{cause}'}}"):
        declare(
            input_("f", "N", ""),
            state("x", "m", ""),
            parameter("p", "1", "", 0.0),
            output("y", "m", "", feedthrough=("f", cause)),
        )


def test_layout_of_a_small_declaration():
    d = declare(
        parameter("p", "1", "", 2.0),
        output("plain", "m", ""),
        output("noded", "m", "", nodes=True),
        input_("f", "N", ""),
        local("count", "s", ""),
        state("x", "m", ""),
        input_("g", "N", ""),
        vectors=[StateVector("q", "m", "", 2), StateVector("der(q)", "m/s", "", 1)],
        tables=11,
    )
    i = d.index
    assert i["x"] == 0
    assert d.state_count == 4  # the hidden ones at 1, 2, 3
    assert d.vector_indices == {"q": 1, "der(q)": 3}
    assert (d.first_input, i["f"], i["g"]) == (4, 4, 4 + STRIDE)
    assert [i[f"g.node{n}"] for n in range(1, NODES + 1)] == [10, 11, 12, 13]
    assert (d.first_output, i["noded"], i["noded.node4"]) == (14, 14, 18)
    assert (i["plain"], i["count"]) == (19, 20)
    assert d.mutable_size == i["p"] == 21
    assert i["interface_degree"] == 22
    assert (d.first_table, d.size) == (23, 34)


def test_stride_is_a_value_and_its_nodes():
    assert STRIDE == NODES + 1 == 5


@pytest.mark.parametrize("name", COMPONENTS)
def test_layout_of_every_component(name):
    d = COMPONENTS[name].declaration
    hidden = range(len(d.states), d.state_count)
    assert sorted([*d.index.values(), *hidden]) == list(range(d.first_table))  # no gap, no overlap
    assert [d.index[v.name] for v in d.states] == list(range(len(d.states)))
    for group, first in ((d.inputs, d.first_input), (d.node_outputs, d.first_output)):
        assert [d.index[v.name] for v in group] == [first + STRIDE * k for k in range(len(group))]
        for v in group:
            nodes = [d.index[f"{v.name}.node{n}"] for n in range(1, NODES + 1)]
            assert nodes == [d.index[v.name] + n for n in range(1, NODES + 1)]
    parameters = [d.index[v.name] for v in d.parameters]
    assert parameters == list(range(d.mutable_size, d.first_table))
    assert d.size == d.first_table + d.tables


@pytest.mark.parametrize("name", COMPONENTS)
def test_motions_of_bodies_do_not_depend_on_inputs_directly(name):
    """House rule: s, v, phi, w of a body have no feedthrough; a has it, and so has every force."""
    for v in COMPONENTS[name].declaration.outputs:
        quantity = v.name.rsplit(".", 1)[-1].split("_")[0]
        if quantity in {"s", "v", "phi", "w"} and "." in v.name:
            assert v.feedthrough == ()
        if quantity in {"a", "f", "tau"} and "." in v.name:
            assert v.feedthrough != ()


def test_unknown_variable():
    with pytest.raises(ParameterError, match="thing has no variable 'q'"):
        declare(state("x", "m", "")).variable("q")

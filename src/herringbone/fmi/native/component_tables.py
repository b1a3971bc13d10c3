"""Rows of the tables by which the wrapper knows a component's block; see component.h."""

from collections.abc import Container, Iterable

from herringbone.core import Declaration, Variable
from herringbone.core.declaring.declaration import INTERFACE_DEGREE, node_name
from herringbone.core.declaring.roles import Quantity
from herringbone.core.declaring.variable import NODES, Causality, Variability
from herringbone.fmi import interface
from herringbone.fmi.native.c_text import number, quoted
from herringbone.fmi.used_states import UsedStates


def _real(variable: Variable, node: int) -> str:
    numbers = (variable.start, variable.minimum, variable.maximum, variable.nominal)
    method = variable.quantity is Quantity.MICRO_STEP or variable.name == INTERFACE_DEGREE
    kinds = int(variable.whole), node, int(bool(variable.items)), int(method)
    return f"{{{', '.join([*map(number, numbers), *map(str, kinds)])}}}"


def block_of(used: UsedStates) -> list[Variable | None]:
    """The variables by index in the block, parameters included; None: a hidden state."""
    declaration = used.component.declaration
    reals = interface.every_real(declaration) | used.scalars()
    return [reals.get(i) for i in range(declaration.first_table)]


def _nodes(declaration: Declaration) -> dict[int, int]:
    """Number of the node, 1 to 4, by index in the block."""
    return {
        declaration.index[variable.name] + node: node
        for variable in declaration.variables
        if variable.nodes
        for node in range(1, NODES + 1)
    }


def unlike_nodes(declaration: Declaration, block: list[Variable | None]) -> list[Variable | None]:
    """What has a name of its own; a node is called after its signal."""
    nodes = _nodes(declaration)
    return [variable for index, variable in enumerate(block) if index not in nodes]


def reals(declaration: Declaration, block: list[Variable | None]) -> Iterable[str]:
    """Start, range and kind of what the block holds."""
    nodes = _nodes(declaration)
    for index, variable in enumerate(block):
        node = nodes.get(index, 0)
        yield _real(variable, node) if variable else "{0.0, 0.0, 0.0, 1.0, 0, 0, 0, 0}"


def access(
    declaration: Declaration, block: list[Variable | None], states: Container[int]
) -> Iterable[str]:
    """Who may set what the block holds, and when."""
    for index, variable in enumerate(block):
        if variable is None or variable.name in declaration.hidden:
            yield "HB_HIDDEN"
        elif variable.state:
            yield "HB_STATE"
        elif index in states:
            yield "HB_ELEMENT"
        elif variable.causality is Causality.INPUT:
            yield "HB_INPUT"
        elif variable.causality is Causality.PARAMETER:
            yield "HB_TUNABLE" if variable.variability is Variability.TUNABLE else "HB_FIXED"
        else:
            yield "HB_OUTPUT" if variable.causality is Causality.OUTPUT else "HB_LOCAL"


def extents(used: UsedStates) -> list[int]:
    """Lengths of the arrays that start in the block, for FMI 3; 0: none does there."""
    declaration = used.component.declaration
    extents = [0] * declaration.first_table
    for variable in declaration.variables:
        first = declaration.index[variable.name]
        extents[first] = int(not variable.items)
        if variable.nodes and node_name(variable.name, 1) not in declaration.hidden:
            extents[first + 1] = NODES
    for first, (_, extent) in used.arrays().items():
        extents[first] = extent
    return extents


def rates(declaration: Declaration, block: list[Variable | None]) -> Iterable[int]:
    """Index of the output that is an output's time derivative, 0 if there is none."""
    for variable in block:
        yield declaration.index[variable.rate] if variable and variable.rate else 0


def vectors(used: UsedStates) -> Iterable[str]:
    """The state vectors whose number of elements a resource file decides."""
    declaration = used.component.declaration
    texts = [text.name for text in declaration.texts]
    for of in used.vectors:
        v = of.vector
        if v.text:
            length, text = declaration.first_table + v.length, texts.index(v.text)
            yield f"{{{len(of.nominals)}, {length}, {text}, {quoted(v.elements)}}}"

"""Which parts are bodies, which are elements, by what their outputs depend on directly.

These are roles in the coupling; what parts are for, such as bearing or housing:
`core.declaring.roles`.
"""

from collections.abc import Mapping, Sequence
from graphlib import CycleError, TopologicalSorter
from typing import NamedTuple

from herringbone.core import StructureError
from herringbone.core.part import Part, of_parts
from herringbone.cosim.structure.connection import Connection
from herringbone.cosim.structure.rates import motion_of_force


class Roles(NamedTuple):
    """Parts by their role; what is no element is a body or, without inputs, a source.

    Attributes:
        elements: in the order in which they feed each other.
        mixed: elements that also have motion of their own.
        feedthrough: bodies whose motion depends directly on the forces on them.
        undeclared: bodies of which that is not known.
        notes: lines that the user should read.
    """

    elements: tuple[int, ...]
    mixed: frozenset[int]
    feedthrough: frozenset[int]
    undeclared: frozenset[int]
    notes: tuple[str, ...]


def find_roles(connections: Sequence[Connection], parts: Sequence[Part]) -> Roles:
    """Roles of all parts.

    A circle of parts that pass inputs directly to outputs is cut where they pass forces: such a
    part is a body. A part whose dependencies are not declared counts as an element unless that
    makes a circle, or it takes forces alone and gives the motions of their ports. One that is known
    to have states is a body, whatever it passes; a part of parts is an element with motion of its
    own: it takes polynomials of what is stepped before it.

    Raises:
        StructureError: a circle in which no part passes forces alone.
    """
    fed = {i: {c.input for c in connections if c.target == i} for i in range(len(parts))}
    passed, undeclared, moving = _passed_inputs(connections, parts, fed)
    several = {p for p, part in enumerate(parts) if of_parts(part)}
    moved = {p for p, inputs in passed.items() if inputs and parts[p].has_states} - several
    elements = {p for p, inputs in passed.items() if inputs} - moved
    feedthrough = {p for p in moved if any(map(motion_of_force, passed[p]))}
    while circle := _circle(elements, passed, connections):
        cut = {p for p in circle if all(map(motion_of_force, passed[p]))}
        if not cut:
            names = " -> ".join(parts[i].name for i in circle)
            raise StructureError(
                f"algebraic loop: {names}; these parts pass inputs directly to outputs in a "
                "circle, put a body (with inertia) between them"
            )
        elements -= cut
        feedthrough |= cut
    notes, bodies = [], set()
    for part in sorted(undeclared - elements - feedthrough):
        alone = {**passed, part: fed[part]}
        moves = _gives_motion_for_force(parts[part], fed[part])
        if moves or _circle({*elements, part}, alone, connections):
            bodies.add(part)
            kind = "a body"
        else:
            elements.add(part)
            passed, kind = alone, "an element"
        notes.append(f"{parts[part].name} declares no output dependencies; taken as {kind}")
    order = tuple(_waiting(elements, passed, connections).static_order())
    mixed = frozenset((moving | several) & elements)
    return Roles(order, mixed, frozenset(feedthrough), frozenset(bodies), tuple(notes))


def _passed_inputs(
    connections: Sequence[Connection], parts: Sequence[Part], fed: Mapping[int, set[str]]
) -> tuple[dict[int, set[str]], set[int], set[int]]:
    """Inputs that each part passes to used outputs; undeclared parts; parts with other outputs."""
    used = {(c.source, c.output) for c in connections}
    feeding = {c.source for c in connections}
    used |= {  # an observer feeds nothing; all that it shows counts
        (i, name)
        for i, part in enumerate(parts)
        if i not in feeding
        for name, v in part.variables.items()
        if v.causality == "output"
    }
    passed: dict[int, set[str]] = {i: set() for i in range(len(parts))}
    undeclared, moving = set(), set()
    for part, output in used:
        dependencies = parts[part].variables[output].dependencies
        if dependencies is None:
            if fed[part]:
                undeclared.add(part)
        elif dependencies & fed[part]:
            passed[part] |= dependencies & fed[part]
        else:
            moving.add(part)
    return passed, undeclared, moving


def _gives_motion_for_force(part: Part, inputs: set[str]) -> bool:
    """True if all inputs are forces, by their names, for which the part gives a motion."""
    outputs = {name for name, v in part.variables.items() if v.causality == "output"}
    return all(not outputs.isdisjoint(motion_of_force(name) or ()) for name in inputs)


def _waiting(
    elements: set[int], passed: Mapping[int, set[str]], connections: Sequence[Connection]
) -> TopologicalSorter:
    """Which element waits for which: only inputs that are passed to outputs make it wait."""
    graph: dict[int, set[int]] = {e: set() for e in elements}
    for c in connections:
        if c.source in elements and c.target in elements and c.input in passed[c.target]:
            graph[c.target].add(c.source)
    return TopologicalSorter(graph)


def _circle(
    elements: set[int], passed: Mapping[int, set[str]], connections: Sequence[Connection]
) -> list[int]:
    """Elements that wait for each other in a circle, the first one again at the end; or none."""
    try:
        _waiting(elements, passed, connections).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []

"""The systems of an SSP file: what each contains, how it is wired, where its elements stand.

A nested system has a connector for each signal that crosses its border, named by the path inside.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from herringbone.core.part import PartVariable
from herringbone.core.places.part_path import PartPath, flat_name
from herringbone.cosim.ssp.described import DescribedPart
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.placing import places

Corners = tuple[float, float, float, float]
"""Lower left and upper right corner, x1, y1, x2, y2 [mm]."""
_WIDE, _HIGH, _GAP = 40.0, 30.0, 20.0
"""Size of elements, and room between them [mm]."""


class Wire(NamedTuple):
    """A connection inside a system; an element "" is the system itself."""

    start: str
    output: str
    end: str
    input: str


@dataclass
class Box:
    """One system.

    Attributes:
        parts: names of its components by the part's place among all.
        systems: names of the systems in it, by their paths.
        connectors: its own ones, by name: part (place among all) and variable.
        wires: its connections.
        places: corners of its elements by name, in its own coordinates.
        corners: its own, in those of the system around it; none of the outermost one.
    """

    parts: dict[int, str] = field(default_factory=dict)
    systems: dict[str, str] = field(default_factory=dict)
    connectors: dict[str, tuple[int, PartVariable]] = field(default_factory=dict)
    wires: dict[Wire, None] = field(default_factory=dict)
    places: dict[str, Corners] = field(default_factory=dict)
    corners: Corners | None = None


def boxes(
    parts: Sequence[DescribedPart], network: Network, ports: Mapping[str, str], *, nested: bool
) -> dict[str, Box]:
    """The systems by their paths; the outermost one is "".

    Args:
        parts: parts of the whole system.
        network: its connections, resolved.
        ports: paths of inner ports by name, whose variables become connectors of the whole.
        nested: nested systems stay so; else all parts are in one.
    """
    scopes = [part.name.scope if nested else "" for part in parts]
    tree = {"": Box()}
    for p, (part, scope) in enumerate(zip(parts, scopes, strict=True)):
        for outer, inner in _borders(scope):
            tree.setdefault(inner, Box())
            tree[outer].systems[inner] = inner.rpartition(".")[2]
        tree[scope].parts[p] = part.name.name if nested else part.label
    names = {p: name for box in tree.values() for p, name in box.parts.items()}
    for c in network.every_connection:
        out = _rising(tree, parts, scopes[c.source], c.source, c.output, scopes[c.target], names)
        _falling(tree, parts, scopes[c.target], (c.target, c.input), out, names)
    for port, path in ports.items():
        _offer(tree, parts, scopes, names, (port, path))
    for box in tree.values():
        _place(box)
    for box in tree.values():
        for scope, name in box.systems.items():
            tree[scope].corners = box.places[name]
    return tree


def coordinates(corners: Corners) -> dict[str, str]:
    """As attributes."""
    return {key: f"{x:g}" for key, x in zip(("x1", "y1", "x2", "y2"), corners, strict=True)}


def _borders(scope: str) -> Iterator[tuple[str, str]]:
    """Outer and inner path of each border from the outermost system to one, from outside."""
    outer = ""
    for name in scope.split(".") if scope else ():
        inner = f"{outer}.{name}" if outer else name
        yield outer, inner
        outer = inner


def _connector(part: DescribedPart, scope: str, variable: str) -> str:
    """Name of a connector of a system around a part: path inside, told from that of the part's."""
    return f"{flat_name(PartPath(part.name[len(scope) + 1 :]))}__{variable}"


def _rising(
    tree: Mapping[str, Box],
    parts: Sequence[DescribedPart],
    scope: str,
    source: int,
    output: str,
    target: str,
    names: Mapping[int, str],
) -> tuple[str, str, str]:
    """Lead an output out to a system that contains the target: its path, element, connector."""
    element, connector = names[source], output
    for outer, inner in reversed(list(_borders(scope))):
        if f"{target}.".startswith(f"{inner}."):
            return inner, element, connector
        name = _connector(parts[source], inner, output)
        tree[inner].connectors[name] = source, parts[source].variables[output]
        tree[inner].wires[Wire(element, connector, "", name)] = None
        element, connector = tree[outer].systems[inner], name
    return "", element, connector


def _falling(
    tree: Mapping[str, Box],
    parts: Sequence[DescribedPart],
    scope: str,
    target: tuple[int, str],
    start: tuple[str, str, str],
    names: Mapping[int, str],
) -> None:
    """Lead what arrives in a system in to the target."""
    place, element, connector = start
    p, variable = target
    for outer, inner in _borders(scope):
        if len(inner) <= len(place):
            continue
        name = _connector(parts[p], inner, variable)
        tree[inner].connectors[name] = p, parts[p].variables[variable]
        tree[outer].wires[Wire(element, connector, tree[outer].systems[inner], name)] = None
        element, connector = "", name
    tree[scope].wires[Wire(element, connector, names[p], variable)] = None


def _offer(
    tree: Mapping[str, Box],
    parts: Sequence[DescribedPart],
    scopes: Sequence[str],
    names: Mapping[int, str],
    port: tuple[str, str],
) -> None:
    """Make the variables of a port connectors of the whole system."""
    name, path = port
    for p, part in enumerate(parts):
        if not path.startswith(f"{part.name}."):
            continue
        inner = path[len(part.name) + 1 :]
        for variable, v in part.variables.items():
            rest = variable[len(inner) :]
            if not variable.startswith(f"{inner}.") or rest.count(".") > 1:
                continue
            own = f"{name}{rest}"
            if v.causality == "input":
                _falling(tree, parts, scopes[p], (p, variable), ("", "", own), names)
            elif v.causality == "output":
                _, element, connector = _rising(tree, parts, scopes[p], p, variable, "", names)
                tree[""].wires[Wire(element, connector, "", own)] = None
            else:
                continue
            tree[""].connectors[own] = p, v


def _place(box: Box) -> None:
    """Place the elements of a system beside each other."""
    names = [*box.parts.values(), *box.systems.values()]
    joined = [(w.start, w.end) for w in box.wires if w.start and w.end]
    found = places(names, joined)
    lowest = max((row for _, row in found.values()), default=0.0)
    for name, (column, row) in found.items():
        x = _GAP + column * (_WIDE + _GAP)
        y = _GAP + (lowest - row) * (_HIGH + _GAP)
        box.places[name] = x, y, x + _WIDE, y + _HIGH

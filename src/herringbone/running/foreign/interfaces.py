"""What parts exchange with others, and what they lack."""

from collections.abc import Iterator, Sequence
from collections.abc import Set as AbstractSet

from herringbone.core.names import first_of
from herringbone.core.part import Part, is_signal_node
from herringbone.cosim.structure.network import build_network
from herringbone.cosim.structure.system import PartSpec, System

_SHOWN = 4
"""Ports of a part in a line."""


def exchanged_outputs(system: System, parts: Sequence[Part]) -> tuple[str, ...]:
    """Outputs of foreign parts that other parts take.

    Args:
        system: of the parts, in the same order.
        parts: as the coupling takes them.
    """
    if not system.foreign_parts:
        return ()
    taken = {(parts[c.source].name, c.output) for c in build_network(system, parts).connections}
    return tuple(f"{part}.{name}" for part, name in sorted(taken) if part in system.foreign_parts)


def unfed(system: System, parts: Sequence[Part]) -> list[str]:
    """Lines on parts that are not connected, or in part, and on foreign values without effect.

    Args:
        system: of the parts, in the same order.
        parts: as the coupling takes them.
    """
    network = build_network(system, parts)
    connections, lines = network.every_connection, []
    for p, (spec, part) in enumerate(zip(system.parts, parts, strict=True)):
        fed = {c.input for c in connections if c.target == p}
        used = fed | {c.output for c in connections if c.source == p}
        if not used:
            lines.append(f"{part.name}: nothing is connected to it")
        elif spec.foreign:
            lines += _partly_fed(spec, part, fed, used)
        elif p in network.elements:
            lines += _held_ends(part, fed)
    return lines


def _partly_fed(
    spec: PartSpec, part: Part, fed: AbstractSet[str], used: AbstractSet[str]
) -> Iterator[str]:
    """Of a foreign part: values without effect, and what is missing of connected ports."""
    if given := sorted(set(spec.values) & (fed | {part.variables[n].array for n in fed})):
        yield (
            f"{part.name}: the start value of {', '.join(given)} has no effect, as what is "
            "connected to it gives another one from the start on"
        )
    ports = {name.rpartition(".")[0] for name in used} - {""}
    missing = [name for name in _open(part, fed) if name.rpartition(".")[0] in ports]
    if missing:
        yield (
            f"{part.name}: {', '.join(missing)} of a connected port are fed by nothing and "
            "keep their start values"
        )


def _held_ends(part: Part, fed: AbstractSet[str]) -> Iterator[str]:
    """Of an element: ports whose motion nobody gives."""
    ports = dict.fromkeys(name.rpartition(".")[0] for name in _open(part, fed))
    if ends := [port for port in ports if port]:
        yield (
            f"{part.name}: nothing is joined to {first_of(ends, _SHOWN)}, which stands "
            "still, as if it were held"
        )


def _open(part: Part, fed: AbstractSet[str]) -> list[str]:
    """Inputs that are fed by nothing."""
    return [
        name
        for name, v in part.variables.items()
        if v.causality == "input" and name not in fed and not is_signal_node(part.variables, name)
    ]

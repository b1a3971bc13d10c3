"""What parts lack: connections to others."""

from collections.abc import Iterator
from collections.abc import Set as AbstractSet

from herringbone.core.names import first_of
from herringbone.core.part import Part, is_signal_node
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.system import PartSpec, System

_SHOWN = 4
"""Ports of a part in a line."""


def unfed(system: System, network: Network) -> list[str]:
    """Lines on parts that are not connected, or in part, and on foreign values without effect.

    Args:
        system: of the network's parts, in the same order.
        network: its connections, resolved.
    """
    connections, lines = network.every_connection, []
    for p, (spec, part) in enumerate(zip(system.parts, network.parts, strict=True)):
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

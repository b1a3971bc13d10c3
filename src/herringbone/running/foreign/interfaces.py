"""What foreign parts exchange with others, and how."""

from collections.abc import Sequence

from herringbone.core.declaring.declaration import is_node
from herringbone.core.part import Part
from herringbone.cosim.structure.network import build_network
from herringbone.cosim.structure.system import System


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
    """Lines on foreign parts that are not connected, or in part, and on values without effect.

    Args:
        system: of the parts, in the same order.
        parts: as the coupling takes them.
    """
    if not system.foreign_parts:
        return []
    connections = build_network(system, parts).every_connection
    lines = []
    for p, (spec, part) in enumerate(zip(system.parts, parts, strict=True)):
        if not spec.foreign:
            continue
        fed = {c.input for c in connections if c.target == p}
        used = fed | {c.output for c in connections if c.source == p}
        if not used:
            lines.append(f"{part.name}: nothing is connected to it")
        if given := sorted(set(spec.values) & (fed | {part.variables[n].array for n in fed})):
            lines.append(
                f"{part.name}: the start value of {', '.join(given)} has no effect, as what is "
                "connected to it gives another one from the start on"
            )
        ports = {name.rpartition(".")[0] for name in used} - {""}
        missing = [
            name
            for name, v in part.variables.items()
            if v.causality == "input"
            and name not in fed
            and name.rpartition(".")[0] in ports
            and not is_node(name)
        ]
        if missing:
            lines.append(
                f"{part.name}: {', '.join(missing)} of a connected port are fed by nothing and "
                "keep their start values"
            )
    return lines

"""What foreign parts exchange with others, and how."""

from collections.abc import Sequence

from herringbone.core.declaration import INTERFACE_DEGREE
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


def holds_inputs(system: System, parts: Sequence[Part]) -> bool:
    """True if a foreign part holds its inputs over a step, which leaves the first order.

    Args:
        system: of the parts, in the same order.
        parts: as the coupling takes them.
    """
    return any(s.foreign and _holds(part) for s, part in zip(system.parts, parts, strict=True))


def _holds(part: Part) -> bool:
    takes = INTERFACE_DEGREE in part.variables or bool(part.addresses.set_derivatives)
    return not takes and any(v.causality == "input" for v in part.variables.values())

"""What parts exchange with others."""

from collections.abc import Sequence

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

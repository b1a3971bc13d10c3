"""A system without some of its parts, as without those of which only the FMI interface is known."""

from collections.abc import Collection
from dataclasses import replace

from herringbone.cosim.structure.system import System


def known_parts(system: System) -> System:
    """The system without its foreign parts and what they are connected to."""
    return without_parts(system, system.foreign_parts)


def without_parts(system: System, names: Collection[str]) -> System:
    """The system without some parts; what they would feed keeps its start value."""
    left_out = set(names)
    return replace(
        system,
        parts=tuple(part for part in system.parts if part.name not in left_out),
        connections=tuple(
            pair
            for pair in system.connections
            if not left_out & {system.split(path)[0] for path in pair}
        ),
        sensors={k: spec for k, spec in system.sensors.items() if spec.part not in left_out},
    )

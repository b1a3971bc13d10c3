"""Bearings that stand on rigid ground although a housing carries them: what is said of them."""

from collections.abc import Iterator
from typing import NamedTuple

from herringbone.analysis.anatomy import anatomy, value_at
from herringbone.core.declaring.roles import PortKind, Quantity, Role
from herringbone.cosim.structure.system import System


class RigidBearing(NamedTuple):
    """A bearing that stands on rigid ground, the variable that says so, housings that it drives."""

    name: str
    column: str
    housings: tuple[str, ...]


def rigid_bearings(system: System) -> Iterator[RigidBearing]:
    """Bearings that drive housings whose motion does not act back."""
    known = anatomy(system)
    for bearing in known.with_role(Role.BEARING):
        column = known.column(bearing, Quantity.SEAT_MOTION)
        if column is None or system.part(bearing).foreign or value_at(system, column) != 0.0:
            continue
        housings = dict.fromkeys(part for part, _ in known.joined(bearing, PortKind.SEAT))
        if housings:
            yield RigidBearing(bearing, column, tuple(housings))


def driven_one_way(system: System) -> Iterator[str]:
    """Lines on housings that bearings drive and whose motion does not act back."""
    for bearing in rigid_bearings(system):
        for housing in bearing.housings:
            yield (
                f"one way: {bearing.name} stands on rigid ground (seat_motion = 0) and drives "
                f"{housing}, whose motion does not act back; power is not balanced there"
            )

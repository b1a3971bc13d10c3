"""What is said of housings that a study drives one way: that they are, and how wrong that is."""

from collections.abc import Iterator
from dataclasses import replace

from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.set_points import SPEED, TORQUE
from herringbone.analysis.steady.operating_point import Point as SteadyPoint
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.places.part_path import PartPath
from herringbone.cosim.structure.system import System
from herringbone.running.housings.rigid_ground import driven_one_way, rigid_bearings
from herringbone.running.operating.by_hand import said_by_hand
from herringbone.studies.evaluators.evaluator import Base
from herringbone.studies.study import SET_POINTS, Point, Study


def one_way_notes(known: System, study: Study, base: Base) -> tuple[str, ...]:
    """Lines as of one state, at the first point with such a housing; none if no point has one.

    Args:
        known: the system, with all values that the study does not vary.
        study: its points.
        base: what they have in common.
    """
    for number in _different(known, study):
        point = study.point(number)
        own = {name: value for name, value in point.items() if name not in SET_POINTS}
        there = known.with_values(own)
        if any(rigid_bearings(there)):
            said = _said(base, point, own)
            at = f" (point {number})" if len(study.points) > 1 else ""
            return (*driven_one_way(there), *(f"{line}{at}" for line in said))
    return ()


def _different(known: System, study: Study) -> list[int]:
    """The first points of those that differ in whether the seats' motion acts back."""
    deciding = set(_seat_motions(known))
    places = [
        k
        for k, name in enumerate(study.names)
        if name not in SET_POINTS and name.rpartition(".")[0] not in known.sensors
        if known.split(name) in deciding
    ]
    first: dict[tuple, int] = {}
    for number, values in enumerate(study.points):
        first.setdefault(tuple(values[k] for k in places), number)
    return list(first.values())


def _seat_motions(known: System) -> Iterator[tuple[PartPath, str]]:
    """Variables that decide on it."""
    found = anatomy(known)
    for bearing in found.with_role(Role.BEARING):
        if column := found.column(bearing, Quantity.SEAT_MOTION):
            yield known.split(column)


def _said(base: Base, point: Point, own: Point) -> tuple[str, ...]:
    """The model error of what a user left out, at a point."""
    speed, torque = (float(point[name]) if name in point else None for name in (SPEED, TORQUE))
    wishes = replace(base.wishes, values={**base.wishes.values, **own})
    at = SteadyPoint(speed, torque)
    return said_by_hand(base.system, base.scene, wishes, at).notes

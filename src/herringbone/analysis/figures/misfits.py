"""What in a run does not fit together: gear pair, bearings, controller, housing, table and scene.

Each is a line with the numbers of both sides. Nothing is refused here: a user may mean it.
"""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from herringbone.analysis.asked import mesh_forces
from herringbone.analysis.figures.modal_response import housing_of
from herringbone.analysis.figures.operating_point import run_mesh_frequency
from herringbone.components.resources.stiffness_table import read_stiffness_table
from herringbone.core import ResourceError
from herringbone.core.roles import GEARS, PortKind, Quantity, Role
from herringbone.housing import ModalHousing
from herringbone.result.result import TIME, Result

_RATIO, _DISTANCE = 1e-3, 1e-3
"""Relative deviation of a ratio, and deviation of a centre distance [m], that is noted."""
_HARMONICS = 3
"""Mesh harmonics that a housing's data should reach."""


def misfits(result: Result) -> tuple[str, ...]:
    """Lines on what does not fit together, each with both numbers."""
    return tuple(
        line
        for gear in result.parts_with(Role.GEAR_PAIR)
        for of in (_of_pair, _of_housing, _of_table, _of_flank)
        for line in of(result, gear)
    )


def _value(result: Result, part: str, quantity: Quantity, place: str | None = None) -> float | None:
    """Parameter of a known part."""
    column = result.info.anatomy.column(part, quantity, place)
    return None if column is None else result.info.parameters.get(column)


def _pair(result: Result, part: str, quantity: Quantity) -> tuple[float, float] | None:
    """Parameter of both gears."""
    found = [_value(result, part, quantity, gear) for gear in GEARS]
    return None if None in found else (found[0] or 0.0, found[1] or 0.0)


def _of_pair(result: Result, gear: str) -> Iterator[str]:
    """Ratio of teeth, of base radii, and of the controller."""
    teeth = _pair(result, gear, Quantity.NUMBER_OF_TEETH)
    if teeth is None or len(result.parts_with(Role.GEAR_PAIR)) > 1:
        return
    ratio = teeth[1] / teeth[0]
    for part in result.parts_with(Role.CONTROLLER):
        own = _value(result, part, Quantity.GEAR_RATIO)
        if own is not None and abs(own / ratio - 1.0) > _RATIO:
            yield (
                f"{part} has a gear ratio of {own:.5g}, {gear} {teeth[0]:g}/{teeth[1]:g} teeth, "
                f"which is {ratio:.5g}: the torques are not those of one load"
            )


def _center_distance(result: Result, gear: str) -> float | None:
    """Centre distance [m] of a pair, by its base radii and the angle of its bearings."""
    radii = _pair(result, gear, Quantity.BASE_RADIUS)
    bearing = result.info.anatomy.neighbour(gear, PortKind.JOURNAL, Role.BEARING)
    if radii is None or bearing is None:
        return None
    angle = _value(result, bearing, Quantity.WORKING_PRESSURE_ANGLE)
    return None if angle is None else sum(radii) / math.cos(angle)


def _of_housing(result: Result, gear: str) -> Iterator[str]:
    anatomy = result.info.anatomy
    bearing = anatomy.neighbour(gear, PortKind.JOURNAL, Role.BEARING)
    part = bearing and anatomy.neighbour(bearing, PortKind.SEAT, Role.HOUSING)
    housing = housing_of(result, part) if part else None
    if housing is None:
        return
    distance, seats = _center_distance(result, gear), _seat_distance(housing)
    if distance and seats and abs(distance - seats) > _DISTANCE:
        yield (
            f"{part} has its bearing seats {1e3 * seats:.1f} mm apart, {gear} a centre distance of "
            f"{1e3 * distance:.1f} mm: the housing belongs to another pair"
        )
    frequency = run_mesh_frequency(result, gear=gear)
    if frequency and _HARMONICS * frequency > housing.valid_to_hz:
        inside = int(housing.valid_to_hz / frequency)
        yield (
            f"{part}: its data are valid to {housing.valid_to_hz:g} Hz, the mesh frequency of "
            f"{gear} is {frequency:.4g} Hz: {inside or 'none'} of its harmonics are inside"
        )


def _seat_distance(housing: ModalHousing) -> float | None:
    """Distance [m] of the seats of pinion and wheel, across the shafts."""
    places: dict[str, list[tuple[float, ...]]] = {gear: [] for gear in GEARS}
    for point in housing.points:
        gear = point.name.partition("_")[0]
        if point.role == "seat" and gear in places:
            places[gear].append(point.position[:2])
    if not all(places.values()):
        return None
    pinion, wheel = (np.mean(places[gear], axis=0) for gear in GEARS)
    return float(np.linalg.norm(wheel - pinion))


def _of_table(result: Result, gear: str) -> Iterator[str]:
    """Load range of the stiffness table, against the forces of the run."""
    anatomy = result.info.anatomy
    column = anatomy.column(gear, Quantity.STIFFNESS_TABLE)
    folder, name = anatomy.parts[gear].resources, result.info.resources.get(column or "", "")
    if not name or folder is None:
        return
    try:
        tables = read_stiffness_table(Path(folder) / name)
    except ResourceError:  # it was read when the run began
        return
    for side, (loads, _) in zip(("left", "right"), tables, strict=True):
        force = mesh_forces(result, gear).get(side)
        largest = float(result.data[force].max()) if force in result.data else 0.0
        if largest > loads[-1]:
            yield (
                f"{gear}: the {side} mesh carries up to {largest:.4g} N, its stiffness table ends "
                f"at {loads[-1]:.4g} N: above that the law goes on as a straight line"
            )


def _of_flank(result: Result, gear: str) -> Iterator[str]:
    """Time with the teeth pressed on the flank whose line of action y is not."""
    flank = _value(result, gear, Quantity.CARRYING_FLANK)
    forces = [column for column in mesh_forces(result, gear).values() if column in result.data]
    if flank is None or not forces:
        return
    carries = -1.0 if flank < 0.0 else 1.0
    other = (carries * result.data[forces].to_numpy() < 0.0).any(axis=1)
    time = result.data[TIME].to_numpy()
    if other.any():
        share = float(other.mean()) * (time[-1] - time[0])
        name, opposite = ("drive", "coast") if carries > 0.0 else ("coast", "drive")
        yield (
            f"{gear}: the {opposite} flank is loaded for {1e3 * share:.4g} ms of "
            f"{1e3 * (time[-1] - time[0]):.4g} ms; y is the line of action of the {name} flank, so "
            "that the separating part of the force has the wrong direction then"
        )

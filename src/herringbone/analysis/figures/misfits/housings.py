"""The housing against the pair that it carries: seats, band, files.

The place of seats is told before a run, see `misplaced_seats`; the rest needs its result.
"""

import math
from collections.abc import Iterator

import numpy as np

from herringbone.analysis.asked import resource_file
from herringbone.analysis.figures.modal_response import housing_of
from herringbone.analysis.figures.operating_point import run_mesh_frequency
from herringbone.core.declaring.roles import GEARS, PortKind, Quantity, Role
from herringbone.core.wording import option
from herringbone.housing import ModalHousing
from herringbone.housing.files.plausibility import implausible
from herringbone.result.result import Result

_DISTANCE, _DIRECTION = 1e-3, math.radians(1.0)
"""Deviations of a centre distance [m] and of its direction [rad] that are noted."""
_HARMONICS = 3
"""Mesh harmonics that a housing's data should reach."""


def of_housing(result: Result, gear: str) -> Iterator[str]:
    """Lines on the housing of a gear pair's bearings."""
    anatomy = result.info.anatomy
    bearing = anatomy.neighbour(gear, PortKind.JOURNAL, Role.BEARING)
    part = bearing and anatomy.neighbour(bearing, PortKind.SEAT, Role.HOUSING)
    if not bearing or not part:
        return
    yield from _of_files(result, part)
    housing = housing_of(result, part)
    if housing is None:
        return
    yield from (f"{part}: {line}" for line in implausible(housing))
    frequency = run_mesh_frequency(result, gear=gear)
    if frequency and _HARMONICS * frequency > housing.valid_to_hz:
        inside = int(housing.valid_to_hz / frequency)
        yield (
            f"{part}: its data are valid to {housing.valid_to_hz:g} Hz, the mesh frequency of "
            f"{gear} is {frequency:.4g} Hz: {inside or 'none'} of its harmonics are inside"
        )


def _of_files(result: Result, part: str) -> Iterator[str]:
    """A line if frequencies and shapes are of different housings."""
    files = [resource_file(result, part, q) for q in (Quantity.MODES, Quantity.SHAPES)]
    if len({file.parent for file in files if file}) > 1:
        yield (
            f"{part} has its modes of {files[0]} and its shapes of {files[1]}: of two housings; "
            f"{option('housing')} takes the folder of one"
        )


def seats_elsewhere(
    names: tuple[str, str, str],
    housing: ModalHousing,
    radii: tuple[float, float] | None,
    angle: float | None,
) -> Iterator[str]:
    """Lines on the place of the wheel's seats, from those of the pinion.

    Args:
        names: of housing, gear pair and bearing.
        housing: its modal data.
        radii: base radii of pinion and wheel [m].
        angle: working pressure angle of the bearing [rad].
    """
    part, gear, bearing = names
    across = _across(housing)
    if across is None:
        return
    seats = float(np.linalg.norm(across))
    if radii is not None and angle is not None:
        distance = sum(radii) / math.cos(angle)
        if abs(distance - seats) > _DISTANCE:
            yield (
                f"{part} has its bearing seats {1e3 * seats:.1f} mm apart, {gear} a centre "
                f"distance of {1e3 * distance:.1f} mm, at the {math.degrees(angle):.2f} deg of "
                f"{bearing}: housing, pair or angle belong to another gearbox"
            )
    direction = math.atan2(across[1], across[0])
    if abs(direction) > _DIRECTION:
        yield (
            f"{part} has the seats of the wheel {math.degrees(direction):.1f} deg from x, as seen "
            f"from those of the pinion; {bearing} takes x as the direction to the wheel"
        )


def _across(housing: ModalHousing) -> np.ndarray | None:
    """From the seats of the pinion to those of the wheel, across the shafts: (x, y) [m]."""
    places: dict[str, list[tuple[float, ...]]] = {gear: [] for gear in GEARS}
    for point in housing.points:
        gear = point.name.partition("_")[0]
        if point.role == "seat" and gear in places:
            places[gear].append(point.position[:2])
    if not all(places.values()):
        return None
    pinion, wheel = (np.mean(places[gear], axis=0) for gear in GEARS)
    return wheel - pinion

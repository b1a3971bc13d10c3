"""What the parts of a run have recorded, asked by role, quantity and port.

Everything is None or empty where no part has the role, or has it without the quantity; what is not
answered, and why, is told by `analysis.unanswered`.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from herringbone.core import ParameterError
from herringbone.core.declaring.roles import GEARS, HALVES, SIDES, PortKind, Quantity, Role
from herringbone.result.result import Result


def signal(
    result: Result, role: Role, quantity: Quantity, place: str | None = None, *, part: str = ""
) -> np.ndarray | None:
    """Recorded quantity of a part with a role, the first one if no name is given, SI unit.

    Returns:
        (n,), or None if there is no such part, or it offers or records no such quantity.
    """
    column = column_of(result, role, quantity, place, part=part)
    return None if column is None else result.data[column].to_numpy()


def column_of(
    result: Result, role: Role, quantity: Quantity, place: str | None = None, *, part: str = ""
) -> str | None:
    """As `signal`, the name of the column."""
    names = (part,) if part else result.parts_with(role)[:1]
    found = (result.info.anatomy.column(name, quantity, place) for name in names)
    return next((column for column in found if column in result.data), None)


def parameter(
    result: Result, part: str, quantity: Quantity, place: str | None = None
) -> float | None:
    """Parameter of a part, SI unit; None if the part is not known to have it."""
    column = result.info.anatomy.column(part, quantity, place)
    return None if column is None else result.info.parameters.get(column)


def of_both_gears(result: Result, part: str, quantity: Quantity) -> tuple[float, float] | None:
    """As `parameter`, of pinion and wheel."""
    pinion, wheel = (parameter(result, part, quantity, gear) for gear in GEARS)
    return None if pinion is None or wheel is None else (pinion, wheel)


def has_own(result: Result, part: str, quantity: Quantity) -> bool:
    """True if a part read a file of the user's for a quantity, not the one that ships."""
    column = result.info.anatomy.column(part, quantity)
    return Path(result.info.resources.get(column or "", "")).is_absolute()


def resource_file(result: Result, part: str, quantity: Quantity) -> Path | None:
    """File that a part read for a quantity; None if that is not known."""
    anatomy = result.info.anatomy
    name = result.info.resources.get(anatomy.column(part, quantity) or "", "")
    folder = anatomy.parts[part].resources
    return folder / name if name and folder is not None else None


def group(result: Result, name: str) -> list[str]:
    """Columns of a channel group, empty if the system has none."""
    try:
        return result.channel(name)
    except ParameterError:
        return []


_PORTS = {
    "bearing_force": (Role.BEARING, PortKind.JOURNAL, "f"),
    "seat_velocity": (Role.HOUSING, PortKind.SEAT, "v"),
}
"""Where the channels of these names are read: role, kind of port, variable."""


def by_half(result: Result, channel: str, axis: str) -> dict[str, str]:
    """Columns of the bearing forces or seat velocities along an axis, by gear half.

    With several bearings, or housings, at the same half, each is named with its part. Where no
    part is known to have such ports, the columns of the channel group are taken.
    """
    role, kind, variable = _PORTS[channel]
    anatomy = result.info.anatomy
    found = [
        (port.place, part, column)
        for part in result.parts_with(role)
        for half in HALVES
        for port in anatomy.ports(part, kind, half)
        if (column := f"{part}.{port.name}.{variable}_{axis}") in result.data
    ]
    halves = [half for half, _, _ in found]
    if len(set(halves)) < len(halves):
        return {f"{part}.{half}": column for half, part, column in found}
    return {half: column for half, _, column in found} or _of_group(result, channel, axis)


def _of_group(result: Result, channel: str, axis: str) -> dict[str, str]:
    found = {}
    for column in group(result, channel):
        *_, half, quantity = ("", *column.split("."))
        if half in HALVES and quantity.endswith(f"_{axis}"):
            found[half] = column
    return found


@dataclass(frozen=True)
class Side:
    """What is joined to one shaft of a gear pair.

    Attributes:
        coupling: name of the shaft coupling at the flange, with the torque; "" without.
        rotor: name of the drive or load behind it; "" without.
    """

    coupling: str
    rotor: str


def shaft_side(result: Result, place: str, gear: str = "") -> Side:
    """Coupling and rotor at the pinion or wheel of a gear pair, the first one if none is given."""
    anatomy = result.info.anatomy
    gears = (gear,) if gear else result.parts_with(Role.GEAR_PAIR)[:1]
    coupling = rotor = None
    for name in gears:
        coupling = anatomy.neighbour(name, PortKind.FLANGE, Role.COUPLING, place)
    for role in (Role.DRIVE, Role.LOAD):
        rotor = rotor or (coupling and anatomy.neighbour(coupling, PortKind.FLANGE, role))
    return Side(coupling or "", rotor or "")


class ShaftTorque(NamedTuple):
    """Where the torque of a shaft is recorded.

    Attributes:
        column: of a coupling, or of another part at the gear's flange.
        sign: of what drives the gearbox; -1 where the column is what acts on the wheel, or is of a
            coupling that hands it the other way.
    """

    column: str
    sign: float = 1.0


def shaft_torques(result: Result, gear: str = "") -> dict[str, ShaftTorque]:
    """Torques by gear: pinion (drive side) and wheel (load side); positive if power flows so.

    Of the coupling at the gear's flange; without one, what is joined to that gives it to the gear.
    """
    found = {}
    for place in GEARS:
        coupling = shaft_side(result, place, gear).coupling
        column = coupling and column_of(result, Role.COUPLING, Quantity.TORQUE, part=coupling)
        if column:
            found[place] = ShaftTorque(column, _handed_on(result, coupling, place, gear))
        elif not coupling and (column := flange_torque(result, place, gear)):
            found[place] = ShaftTorque(column, 1.0 if place == GEARS[0] else -1.0)
    return found


def _handed_on(result: Result, coupling: str, place: str, gear: str) -> float:
    """1.0 if a coupling's torque, from its first flange to its second, goes to load from drive."""
    anatomy = result.info.anatomy
    first, *_ = (port.name for port in anatomy.ports(coupling, PortKind.FLANGE))
    from_gear = (coupling, first) in _at_flange(result, place, gear)
    return 1.0 if from_gear == (place == GEARS[1]) else -1.0


def flange_torque(result: Result, place: str, gear: str = "") -> str | None:
    """Column of the torque that what is joined to a gear's flange gives to it; None without."""
    columns = (f"{'.'.join(end)}.tau" for end in _at_flange(result, place, gear))
    return next((column for column in columns if column in result.data), None)


def _at_flange(result: Result, place: str, gear: str) -> list[tuple[str, str]]:
    """Part and port's name of what is joined to a gear's flange; of the first pair without one."""
    anatomy = result.info.anatomy
    gears = (gear,) if gear else result.parts_with(Role.GEAR_PAIR)[:1]
    return [end for name in gears for end in anatomy.joined(name, PortKind.FLANGE, place)]


def mesh_forces(result: Result, gear: str = "") -> dict[str, str]:
    """Columns of the normal forces of a pair's meshes by side: left and right."""
    columns = {
        side: column_of(result, Role.GEAR_PAIR, Quantity.MESH_FORCE, side, part=gear)
        for side in SIDES
    }
    return {side: column for side, column in columns.items() if column}

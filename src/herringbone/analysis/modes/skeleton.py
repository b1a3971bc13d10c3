"""Where gears and bearing seats stand, and how they move in a mode: what is drawn of it.

Schematic: pinion and wheel stand a unit apart along x, their halves a unit along z. Motions are in
the housing's frame; a gear's y, the line of action, lies at (flank sin a, cos a) in it, with a the
working pressure angle that the bearings tell, and flank 1 (drive) or -1 (coast), as carries.
"""

import math
from typing import NamedTuple

import numpy as np

from herringbone.analysis.anatomy import anatomy, carrying_flank, value_at
from herringbone.analysis.modes.natural_modes import NaturalModes
from herringbone.core import ParameterError
from herringbone.core.declaring.anatomy import Anatomy
from herringbone.core.declaring.roles import GEARS, HALVES, PortKind, Quantity, Role

_PLACES = {
    "pinion_left": (0.0, 0.0, 0.5),
    "pinion_right": (0.0, 0.0, -0.5),
    "wheel_left": (1.0, 0.0, 0.5),
    "wheel_right": (1.0, 0.0, -0.5),
}


class Skeleton(NamedTuple):
    """Motions of gear halves and seats in all modes, all to one scale.

    Attributes:
        places: (4, 3) of the halves in the order of `HALVES`.
        gears: (4, 3, n) translations [m], complex; None without gear pair.
        turns: (4, n) rotation times base radius [m], complex; None without.
        seats: (4, 3, n) translations [m], complex; None without housing.
    """

    places: np.ndarray
    gears: np.ndarray | None
    turns: np.ndarray | None
    seats: np.ndarray | None


def skeleton(found: NaturalModes) -> Skeleton:
    """Motions of the first gear pair and the first housing.

    Raises:
        ParameterError: the system has neither with ports at the four halves.
    """
    known = anatomy(found.system)
    gears, turns = _gears(found, known)
    seats = _seats(found, known)
    if gears is None and seats is None:
        raise ParameterError(
            f"system '{found.system.name}' has neither a gear pair nor a housing whose shapes "
            "could be drawn"
        )
    return Skeleton(np.array([_PLACES[half] for half in HALVES]), gears, turns, seats)


def _motions(found: NaturalModes, part: str, ports: dict[str, str], axes: str) -> np.ndarray | None:
    """(4, axes, n) motions of a part's ports; None if it has not all four."""
    if set(ports) != set(HALVES):
        return None
    columns = [[f"{part}.{ports[half]}.s_{axis}" for axis in axes] for half in HALVES]
    if any(c not in found.linear.core.names for row in columns for c in row):
        return None
    return np.array([[found.motion(c) for c in row] for row in columns])


def _ports(known: Anatomy, part: str, kind: PortKind) -> dict[str, str]:
    return {port.place: port.name for port in known.parts[part].ports if port.kind is kind}


def _gears(found: NaturalModes, known: Anatomy) -> tuple[np.ndarray | None, np.ndarray | None]:
    pairs = known.with_role(Role.GEAR_PAIR)
    if not pairs:
        return None, None
    own = _motions(found, pairs[0], _ports(known, pairs[0], PortKind.JOURNAL), "yz")
    if own is None:
        return None, None
    angle = carrying_flank(found.system, pairs[0]) * _pressure_angle(found, known)
    y, z = own[:, 0], own[:, 1]
    moved = np.stack([math.sin(angle) * y, math.cos(angle) * y, z], axis=1)
    flanges = _ports(known, pairs[0], PortKind.FLANGE)
    turns = np.zeros((len(HALVES), found.rates.size), dtype=complex)
    for i, half in enumerate(HALVES):
        gear = half.partition("_")[0]
        column = known.column(pairs[0], Quantity.BASE_RADIUS, gear)
        if column is not None and gear in flanges:
            phi = found.motion(f"{pairs[0]}.{flanges[gear]}.phi")
            sense = 1.0 if gear == GEARS[0] else -1.0  # the wheel's angle counts the other way
            turns[i] = sense * value_at(found.system, column) * phi
    return moved, turns


def _pressure_angle(found: NaturalModes, known: Anatomy) -> float:
    for part in known.parts:
        column = known.column(part, Quantity.WORKING_PRESSURE_ANGLE)
        if column is not None:
            return value_at(found.system, column)
    return 0.0


def _seats(found: NaturalModes, known: Anatomy) -> np.ndarray | None:
    housings = known.with_role(Role.HOUSING)
    if not housings:
        return None
    return _motions(found, housings[0], _ports(known, housings[0], PortKind.SEAT), "xyz")

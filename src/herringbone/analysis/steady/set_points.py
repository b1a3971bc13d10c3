"""Speed and torque of an operating point: the set points that a system declares."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from herringbone.analysis.anatomy import anatomy, value_at
from herringbone.analysis.twin.condensed.system import Condensed
from herringbone.components.registry import component
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import GEARS, PortKind, Quantity, Role
from herringbone.core.declaring.variable import Causality
from herringbone.cosim.structure.system import System


class Point(NamedTuple):
    """An operating point; None: as the system has it.

    Attributes:
        speed: of the pinion [rad/s].
        torque: at the pinion [N m].
        values: other variables, by `instance.variable`.
    """

    speed: float | None = None
    torque: float | None = None
    values: Mapping[str, float] = {}


class SetPoints:
    """What speed and torque stand for in a system.

    An output that commands, as of a controller, is a signal; an input that nothing is joined to
    is a value. A gear pair with nothing at its flanges has both itself: its speed, which nothing
    changes, and its torques, which are values.

    Args:
        system: whose they are.
    """

    def __init__(self, system: System) -> None:
        self._system, self._known = system, anatomy(system)
        fed = {system.split(path) for pair in system.connections for path in pair}
        self._declared = {
            quantity: [
                (f"{part.name}.{v.name}", v.causality is Causality.INPUT)
                for part in system.parts
                if part.component
                for v in component(part.component).declaration.offered(quantity)
                if v.causality is Causality.OUTPUT or (part.name, v.name) not in fed
            ]
            for quantity in (Quantity.SPEED_SETPOINT, Quantity.TORQUE_SETPOINT)
        }

    @property
    def _open(self) -> str | None:
        """The only gear pair, if nothing is joined to its flanges."""
        pairs = self._known.with_role(Role.GEAR_PAIR)
        if len(pairs) == 1 and not self._known.joined(pairs[0], PortKind.FLANGE):
            return pairs[0]
        return None

    def signals(self, condensed: Condensed, late: float, point: Point) -> np.ndarray:
        """Signals of the sources (signals,) at an operating point.

        Raises:
            ParameterError: the system has no such set point.
        """
        found = condensed.signals(late)
        twin = condensed.twin
        places = [place for _, place in condensed.equations.signals]
        for quantity, wanted in (
            (Quantity.SPEED_SETPOINT, point.speed),
            (Quantity.TORQUE_SETPOINT, point.torque),
        ):
            if wanted is None or self._open is not None:
                continue
            column, given = self._set_point(quantity)
            if given:
                continue
            place = twin.index(column)
            if place not in places:
                raise ParameterError(f"{column} is joined to nothing; set what drives by values")
            found[places.index(place)] = wanted * self._ratio(column, quantity)
        return found

    def values(self, point: Point) -> dict[str, float]:
        """Values that stand for an operating point, besides signals and the free speed."""
        found = dict(point.values)
        pair = self._open
        if point.torque is not None and pair is not None:
            ports = [self._known.ports(pair, PortKind.FLANGE, gear)[0].name for gear in GEARS]
            radii = [
                value_at(self._system, str(self._known.column(pair, Quantity.BASE_RADIUS, gear)))
                for gear in GEARS
            ]
            found = {
                f"{pair}.{ports[0]}.tau": point.torque,
                f"{pair}.{ports[1]}.tau": -point.torque * radii[1] / radii[0],
                **found,
            }
        elif pair is None:
            for quantity, wanted in (
                (Quantity.SPEED_SETPOINT, point.speed),
                (Quantity.TORQUE_SETPOINT, point.torque),
            ):
                if wanted is not None:
                    column, given = self._set_point(quantity)
                    found |= {column: wanted} if given else {}
        return found

    def _set_point(self, quantity: Quantity) -> tuple[str, bool]:
        """The variable, and whether it is an input that takes a value."""
        declared = self._declared[quantity]
        if len(declared) == 1:
            return declared[0]
        what = "speed" if quantity is Quantity.SPEED_SETPOINT else "torque"
        raise ParameterError(
            f"{what}: system '{self._system.name}' declares {len(declared) or 'no'} set points of "
            f"it; the {what} follows from what drives and loads it, set that by values"
        )

    def _ratio(self, column: str, quantity: Quantity) -> float:
        """Torque set points may be behind a ratio."""
        part = self._system.split(column)[0]
        ratio = self._known.column(part, Quantity.GEAR_RATIO)
        if quantity is Quantity.SPEED_SETPOINT or ratio is None:
            return 1.0
        return value_at(self._system, ratio)

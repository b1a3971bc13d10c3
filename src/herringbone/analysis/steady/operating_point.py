"""Speed and torque of an operating point: the set points that a system declares."""

import math
from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from herringbone.analysis.anatomy import anatomy, value_at
from herringbone.analysis.set_points import SPEED, TORQUE, SetPoint, at_pinion, set_point
from herringbone.analysis.twin.condensed.system import Condensed
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import GEARS, PortKind, Quantity, Role
from herringbone.cosim.structure.system import System


class Point(NamedTuple):
    """An operating point; None: as the system has it.

    Attributes:
        speed: set point that the system declares, at its own shaft [rad/s].
        torque: the same [N m].
        values: other variables, by `instance.variable`.
    """

    speed: float | None = None
    torque: float | None = None
    values: Mapping[str, float] = {}

    def check(self) -> None:
        """Raise ParameterError unless it turns, and numbers are finite."""
        if self.speed is not None and not (math.isfinite(self.speed) and self.speed != 0.0):
            raise ParameterError(
                f"speed = {self.speed:g} rad/s: it must be finite and not 0, as a steady state "
                "repeats with the mesh"
            )
        if self.torque is not None and not math.isfinite(self.torque):
            raise ParameterError(f"torque = {self.torque:g} N m: it must be finite")


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
        self._addressed: dict[str, SetPoint | None] = {}

    def _asked(self, point: Point) -> Iterator[tuple[str, float, SetPoint | None]]:
        """Name and value of what is asked for, and what it addresses."""
        for name, wanted in ((SPEED, point.speed), (TORQUE, point.torque)):
            if wanted is None:
                continue
            if name not in self._addressed:  # a search through all parts, and points are many
                self._addressed[name] = set_point(self._system, name)
            yield name, wanted, self._addressed[name]

    def signals(self, condensed: Condensed, still: np.ndarray, point: Point) -> np.ndarray:
        """Signals of the sources (signals,) at an operating point.

        Args:
            condensed: the system.
            still: its own signals.
            point: operating point.

        Raises:
            HerringboneError: the system has no such set point, or several.
        """
        found = still.copy()
        places = [place for _, place in condensed.equations.signals]
        for name, wanted, at in self._asked(point):
            if at is None or at.given:
                continue
            place = condensed.twin.index(str(at))
            if place not in places:
                raise ParameterError(f"{at} is joined to nothing; set what drives by values")
            found[places.index(place)] = wanted * self._ratio(at, name)
        return found

    def values(self, point: Point) -> dict[str, float]:
        """Values that stand for an operating point, besides signals and the free speed."""
        found: dict[str, float] = {}
        for name, wanted, at in self._asked(point):
            if at is not None and at.given:
                found[str(at)] = wanted
            elif at is None and name == TORQUE:
                found |= self._balanced(wanted)
        return found | dict(point.values)

    def _balanced(self, torque: float) -> dict[str, float]:
        """Torques at both flanges of the gear pair that nothing is joined to."""
        (pair,) = self._known.with_role(Role.GEAR_PAIR)
        (wheel,) = self._known.ports(pair, PortKind.FLANGE, GEARS[1])
        pinion_radius, wheel_radius = (
            value_at(self._system, str(self._known.column(pair, Quantity.BASE_RADIUS, gear)))
            for gear in GEARS
        )
        balance = {f"{pair}.{wheel.name}.tau": -torque * wheel_radius / pinion_radius}
        return at_pinion(self._system, torque=torque) | balance

    def _ratio(self, at: SetPoint, name: str) -> float:
        """Torque set points may be behind a ratio."""
        ratio = self._known.column(at.part, Quantity.GEAR_RATIO)
        return 1.0 if name == SPEED or ratio is None else value_at(self._system, ratio)

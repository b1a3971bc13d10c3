"""What a system of components gives to others in a steady motion in which these answer."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from herringbone.analysis.answered import Answers
from herringbone.analysis.equilibrium import answered_equilibrium
from herringbone.analysis.rigid_rotation import names_of_states
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core.part import Part
from herringbone.cosim.structure.approach import Approach
from herringbone.cosim.structure.rates import rate_of
from herringbone.cosim.structure.system import System, Values

ANGLE, SPEED = "rad", "rad/s"
_LOADS = "N", "N.m"
_STANDS = 1e-9
"""Speed [rad/s] and acceleration [rad/s^2] of an angle that stands."""


class Output(NamedTuple):
    """An output in steady motion.

    Attributes:
        value: now.
        speed: of an angle [rad/s]; 0 for all else.
        by_acceleration: rate of the speed, of an angle's or of what is one, at an acceleration of
            1 rad/s^2 of the fastest shaft.
        is_speed: it is one.
    """

    value: float
    speed: float
    by_acceleration: float
    is_speed: bool


@dataclass(frozen=True)
class OwnMotion:
    """Components in steady motion.

    Attributes:
        values: start values by `instance.variable`.
        acceleration: of the fastest shaft [rad/s^2].
        outputs: what others take, by path.
        angles: angles that turn, by path of the state.
        fastest: path of the speed of the fastest shaft; "" where the drivetrain cannot turn as a
            whole, or something holds its speed.
        loads: largest force and torque that own parts exchange, by unit.
    """

    values: Values
    acceleration: float
    outputs: Mapping[str, Output]
    angles: Mapping[str, Output]
    fastest: str
    loads: Mapping[str, float]

    def at_acceleration(self, acceleration: float) -> "OwnMotion":
        """The same at another acceleration [rad/s^2]; own parts do not balance then."""
        return replace(self, acceleration=acceleration)

    def approached(self, acceleration: float, before: Approach, now: Approach) -> "OwnMotion":
        """The same with angles as another acceleration [rad/s^2], or another way, turns them.

        Args:
            acceleration: own parts do not balance at another one.
            before: way of shafts by which this motion has its angles.
            now: by which it gets them.
        """
        other = self.at_acceleration(acceleration)

        def turned(output: Output) -> float:
            if output.is_speed:
                return output.value
            further = now.turned(*other.rates(output)) - before.turned(*self.rates(output))
            return output.value + further

        found = {path: y._replace(value=turned(y)) for path, y in self.outputs.items()}
        return replace(other, outputs=found)

    def turns(self, path: str) -> bool:
        """If an output is an angle that turns, or begins to: one that stands may speed up."""
        output = self.outputs[path]
        return not output.is_speed and max(map(abs, self.rates(output))) > _STANDS

    def rates(self, output: Output) -> tuple[float, float]:
        """Rate and second rate of an output."""
        second = self.acceleration * output.by_acceleration
        return (second, 0.0) if output.is_speed else (output.speed, second)


def own_motion(system: System, answers: Answers, taken: Sequence[str]) -> OwnMotion:
    """Components in equilibrium with what others answer.

    Args:
        system: of components.
        answers: of others.
        taken: paths of outputs that others take.

    Raises:
        EquilibriumError: there is none.
    """
    twin = Twin(system)
    found = answered_equilibrium(twin, answers)
    x, turned = found.states, found.states + found.rotation
    speeds = {path: _speed(twin, path) for path in taken}
    units = _units_of_loads(twin)
    columns = list(dict.fromkeys([*taken, *filter(None, speeds.values()), *units]))
    at, faster = (
        dict(
            zip(columns, map(float, twin.observe(np.zeros(1), s[:, None], columns)[0]), strict=True)
        )
        for s in (x, turned)
    )
    outputs = {}
    for path, speed in speeds.items():
        change = faster[speed] - at[speed] if speed else 0.0
        is_speed = speed == path
        outputs[path] = Output(
            at[path], at[speed] if speed and not is_speed else 0.0, change, is_speed
        )
    names, dx = names_of_states(twin), twin.rhs(0.0, x)
    change = twin.rhs(0.0, turned) - dx
    angles = {
        names[i]: Output(float(x[i]), float(dx[i]), float(change[i]), False) for i in twin.turning
    }
    rotation = np.abs(found.rotation)
    fastest = names[int(np.argmax(rotation))] if rotation.any() else ""
    loads = dict.fromkeys(_LOADS, 0.0)
    for path, unit in units.items():
        loads[unit] = max(loads[unit], abs(at[path]))
    return OwnMotion(found.values, found.acceleration, outputs, angles, fastest, loads)


def _units_of_loads(twin: Twin) -> dict[str, str]:
    """Units of forces and torques that parts give each other, by path."""
    parts = twin.network.parts
    given = dict.fromkeys((parts[c.source], c.output) for c in twin.network.connections)
    units = {f"{part.name}.{name}": part.variables[name].unit for part, name in given}
    return {path: unit for path, unit in units.items() if unit in _LOADS}


def _speed(twin: Twin, path: str) -> str | None:
    """The output that is the speed of an angle, by path; a speed's own; None for all else."""
    instance, name = twin.system.split(path)
    part: Part = next(part for part in twin.network.parts if part.name == instance)
    unit = part.variables[name].unit
    if unit == SPEED:
        return path
    rate = rate_of(part, name) if unit == ANGLE else None
    return f"{part.name}.{rate}" if rate else None

"""What speed and torque address: the set points that a system declares."""

import math
from typing import NamedTuple

from herringbone.analysis.anatomy import anatomy, value_at
from herringbone.components.registry import component
from herringbone.core import ParameterError, StructureError
from herringbone.core.declaring.roles import GEARS, PortKind, Quantity, Role
from herringbone.core.declaring.units import R_MIN
from herringbone.core.declaring.variable import Causality
from herringbone.core.wording import setting, settings
from herringbone.cosim.structure.system import System

SPEED, TORQUE = "speed", "torque"
QUANTITIES = {SPEED: Quantity.SPEED_SETPOINT, TORQUE: Quantity.TORQUE_SETPOINT}
_FASTEST = 1e6
"""Mesh frequency [Hz] beyond which no body of a tooth is left that could be elastic: in a period
sound in steel goes 5 mm."""


class SetPoint(NamedTuple):
    """A variable that commands speed or torque.

    Attributes:
        part, variable: what it is.
        given: it is an input that takes a start value; else an output of what commands.
    """

    part: str
    variable: str
    given: bool

    def __str__(self) -> str:
        return f"{self.part}.{self.variable}"


def set_point(system: System, name: str) -> SetPoint | None:
    """What speed or torque addresses; None: the free flanges of the only gear pair.

    Args:
        system: whose set points they are.
        name: SPEED or TORQUE.

    Raises:
        ParameterError: nothing in the system commands it.
        StructureError: several parts do.
    """
    fed = {system.split(path) for pair in system.connections for path in pair}
    found = [
        SetPoint(str(part.name), v.name, v.causality is Causality.INPUT)
        for part in system.parts
        if part.component
        for v in component(part.component).declaration.offered(QUANTITIES[name])
        if v.causality is Causality.OUTPUT or (part.name, v.name) not in fed
    ]
    if len(found) > 1:
        raise StructureError(
            f"{name}: {system.name} has the set points {', '.join(map(str, found))}; vary them "
            f"with {setting(str(found[0]), '...')}"
        )
    if not found:
        _check_free(system, name)
        return None
    return found[0]


def addressed(system: System, name: str) -> str:
    """What speed or torque addresses, for people; raises as `set_point`."""
    found = set_point(system, name)
    if found is not None:
        return str(found)
    return ", ".join(at_pinion(system, **{name: 1.0}))


def at_pinion(
    system: System, speed: float | None = None, torque: float | None = None
) -> dict[str, float]:
    """Speed and torque of the only gear pair, by path.

    Raises:
        StructureError: there is not one gear pair that is a component.
        ParameterError: something is joined to it, that decides on its speed and torque.
    """
    known = anatomy(system)
    pairs = [name for name in known.with_role(Role.GEAR_PAIR) if not system.part(name).foreign]
    if len(pairs) != 1:
        raise StructureError(
            f"system '{system.name}' has {len(pairs)} gear pairs; speed and torque are of one"
        )
    joined = known.joined(pairs[0], PortKind.FLANGE)
    if joined:
        raise ParameterError(
            f"speed and torque of {pairs[0]} follow from {', '.join(part for part, _ in joined)}; "
            "set what drives and loads them by values"
        )
    found: dict[str, float] = {}
    if speed is not None:
        found[speed_of(system, pairs[0])] = speed
    if torque is not None:
        (pinion,) = known.ports(pairs[0], PortKind.FLANGE, GEARS[0])
        found[f"{pairs[0]}.{pinion.name}.tau"] = torque
    return found


def _check_free(system: System, name: str) -> None:
    """Raise ParameterError unless a gear pair with free flanges takes it."""
    try:
        at_pinion(system, **{name: 1.0})
    except (ParameterError, StructureError):
        known = [str(p.name) for p in system.parts if p.component and _drives(p.component)]
        such_as = setting(f"{known[0] if known else 'PART'}.NAME", "...")
        raise ParameterError(
            f"{name}: no part of {system.name} declares a {QUANTITIES[name]}; vary what drives and "
            f"loads it with {such_as}{_start_speed(system) if name == SPEED else ''}"
        ) from None


def _start_speed(system: System) -> str:
    """How gears beside foreign parts come to a speed, for the end of a message; "": not at all.

    Beside own parts alone the start is the steady rotation, which decides on it.
    """
    pairs = [n for n in anatomy(system).with_role(Role.GEAR_PAIR) if not system.part(n).foreign]
    if not pairs or not system.foreign_parts:
        return ""
    speeds = settings({speed_of(system, pair): "RAD_PER_S" for pair in pairs})
    return f"; where the start is no equilibrium, {speeds} is the gears' speed, else 0"


def speed_of(system: System, pair: str) -> str:
    """Path of the state that is the speed of a gear pair's pinion."""
    declaration = component(str(system.part(pair).component)).declaration
    turning = next(v.name for v in declaration.states if v.steady == "rotating")
    return f"{pair}.der({turning})"


def check_speed(speed: float, teeth: float) -> None:
    """Refuse a speed at which teeth cannot mesh.

    Args:
        speed: [rad/s].
        teeth: how many of them mesh in a turn at that speed.

    Raises:
        ParameterError: it is too high.
    """
    most = 2.0 * math.pi * _FASTEST / teeth
    if abs(speed) > most:
        raise ParameterError(
            f"speed = {speed:g} rad/s ({speed * R_MIN:g} r/min): at most {most:.4g} rad/s "
            f"({most * R_MIN:.4g} r/min), where teeth mesh {_FASTEST:g} times a second and sound "
            "goes through a tooth but once; ask for a lower speed"
        )


def pinion_teeth(system: System, pair: str) -> float | None:
    """Number of teeth of a gear pair's pinion; None of a foreign one, or if it tells none."""
    column = anatomy(system).column(pair, Quantity.NUMBER_OF_TEETH, GEARS[0])
    return value_at(system, column) if column and not system.part(pair).foreign else None


def _drives(name: str) -> bool:
    return bool({Role.SOURCE, Role.DRIVE, Role.LOAD} & set(component(name).declaration.roles))

"""What speed and torque address: the set points that a system declares."""

from typing import NamedTuple

from herringbone.components.registry import component
from herringbone.core import Instance, ParameterError, StructureError
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.declaring.variable import Causality
from herringbone.cosim.structure.system import System
from herringbone.running.own_master import at_pinion
from herringbone.studies.study import SPEED, TORQUE, Point

_QUANTITIES = {SPEED: Quantity.SPEED_SETPOINT, TORQUE: Quantity.TORQUE_SETPOINT}


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

    Raises:
        ParameterError: nothing in the system commands it.
        StructureError: several parts do.
    """
    fed = {system.split(path) for pair in system.connections for path in pair}
    found = [
        SetPoint(str(part.name), v.name, v.causality is Causality.INPUT)
        for part in system.parts
        if part.component
        for v in component(part.component).declaration.offered(_QUANTITIES[name])
        if v.causality is Causality.OUTPUT or (part.name, v.name) not in fed
    ]
    if len(found) > 1:
        raise StructureError(
            f"{name}: {system.name} has the set points {', '.join(map(str, found))}; vary them "
            "with --set"
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


def commanded(system: System, point: Point) -> Point:
    """A point whose speed [rad/s] and torque [N m] are values of variables.

    Args:
        system: with all values but these.
        point: of a study.

    Raises:
        HerringboneError: see `set_point`; or what commands cannot have the value.
    """
    values = {name: value for name, value in point.items() if name not in _QUANTITIES}
    for name in _QUANTITIES:
        if name in point:
            values |= _values(system, name, float(point[name]))
    return values


def _values(system: System, name: str, value: float) -> Point:
    found = set_point(system, name)
    if found is None:
        return dict(at_pinion(system, **{name: value}))
    if found.given:
        return {str(found): value}
    part = system.part(found.part)
    instance = Instance(component(str(part.component)), found.part)
    if instance.component.commanded is None:
        raise ParameterError(f"{name}: {found} takes no value from outside; vary what it has")
    for variable, given in part.values.items():
        instance.set(variable, given)
    instance.load_resources()
    try:
        values = instance.component.commanded(instance.block, _QUANTITIES[name], value)
    except ParameterError as error:
        raise ParameterError(f"{name}: {found.part}: {error}") from None
    return {f"{found.part}.{variable}": factor for variable, factor in values.items()}


def _check_free(system: System, name: str) -> None:
    """Raise ParameterError unless a gear pair with free flanges takes it."""
    try:
        at_pinion(system, **{name: 1.0})
    except (ParameterError, StructureError):
        known = [str(p.name) for p in system.parts if p.component and _drives(p.component)]
        what = (
            f"vary what drives and loads it with --set, such as {known[0]}"
            if known
            else ("vary what drives and loads it with --set")
        )
        raise ParameterError(
            f"{name}: no part of {system.name} declares a {_QUANTITIES[name]}; {what}"
        ) from None


def _drives(name: str) -> bool:
    return bool({Role.SOURCE, Role.DRIVE, Role.LOAD} & set(component(name).declaration.roles))

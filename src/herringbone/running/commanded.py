"""Speed and torque of an operating point, as values of variables."""

from collections.abc import Mapping

from herringbone.analysis.set_points import QUANTITIES, at_pinion, set_point
from herringbone.components.registry import component
from herringbone.core import Instance, ParameterError
from herringbone.cosim.structure.system import System

Point = Mapping[str, float | str]
"""Values by parameter: `speed`, `torque`, or `instance.variable`."""


def commanded(system: System, point: Point) -> dict[str, float | str]:
    """A point whose speed [rad/s] and torque [N m] are values of variables.

    Args:
        system: with all values but these.
        point: speed, torque and others.

    Raises:
        HerringboneError: see `set_point`; or what commands cannot have the value.
    """
    values = dict(point)
    asked = {name: float(values.pop(name)) for name in QUANTITIES if name in point}
    for name, value in asked.items():
        values |= _values(system, name, value)
    return values


def _values(system: System, name: str, value: float) -> dict[str, float]:
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
        values = instance.component.commanded(instance.block, QUANTITIES[name], value)
    except ParameterError as error:
        raise ParameterError(f"{name}: {found.part}: {error}") from None
    return {f"{found.part}.{variable}": factor for variable, factor in values.items()}

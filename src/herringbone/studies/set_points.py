"""Speed and torque of a study's points, as values of variables."""

from herringbone.analysis.set_points import QUANTITIES, at_pinion, set_point
from herringbone.components.registry import component
from herringbone.core import Instance, ParameterError
from herringbone.cosim.structure.system import System
from herringbone.studies.study import Point


def commanded(system: System, point: Point) -> Point:
    """A point whose speed [rad/s] and torque [N m] are values of variables.

    Args:
        system: with all values but these.
        point: of a study.

    Raises:
        HerringboneError: see `set_point`; or what commands cannot have the value.
    """
    values = {name: value for name, value in point.items() if name not in QUANTITIES}
    for name in QUANTITIES:
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
        values = instance.component.commanded(instance.block, QUANTITIES[name], value)
    except ParameterError as error:
        raise ParameterError(f"{name}: {found.part}: {error}") from None
    return {f"{found.part}.{variable}": factor for variable, factor in values.items()}

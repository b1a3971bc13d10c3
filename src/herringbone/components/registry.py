"""The components that exist, by name."""

from herringbone.components.bearing_supports import BEARING_SUPPORTS
from herringbone.components.bench_controller import BENCH_CONTROLLER
from herringbone.components.drive_motor import DRIVE_MOTOR
from herringbone.components.gear_mesh import GEAR_MESH
from herringbone.components.load_motor import LOAD_MOTOR
from herringbone.components.modal_housing import MODAL_HOUSING
from herringbone.components.shaft_coupling import SHAFT_COUPLING
from herringbone.components.velocity_sensor import VELOCITY_SENSOR
from herringbone.core import Component, StructureError

COMPONENTS: dict[str, Component] = {
    component.name: component
    for component in (
        GEAR_MESH,
        BEARING_SUPPORTS,
        MODAL_HOUSING,
        DRIVE_MOTOR,
        LOAD_MOTOR,
        SHAFT_COUPLING,
        BENCH_CONTROLLER,
        VELOCITY_SENSOR,
    )
}


def component(name: str) -> Component:
    """The component of that name.

    Raises:
        StructureError: there is none.
    """
    try:
        return COMPONENTS[name]
    except KeyError:
        known = ", ".join(COMPONENTS)
        raise StructureError(f"there is no component '{name}'; there are: {known}") from None

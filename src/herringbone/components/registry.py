"""The components that exist, by name.

A new component is a module here and a line in this registry; what else belongs to it is generated:
`python -m herringbone.fmi.generate NAME`.
"""

from importlib import import_module

from herringbone.core import Component, StructureError
from herringbone.core.declaring.roles import Role
from herringbone.core.names import meant

_MODULES = (
    "gear_mesh",
    "bearing_supports",
    "modal_housing",
    "drive_motor",
    "load_motor",
    "shaft_coupling",
    "bench_controller",
    "velocity_sensor",
    "drivetrain.rotating_inertia",
    "drivetrain.geared_shaft",
    "drivetrain.elastic_shaft",
    "drivetrain.torque_source",
    "drivetrain.speed_source",
    "drivetrain.freewheel",
    "drivetrain.rising_value",
)
"""Each defines the component of its name, in capitals. The first one of a role is the usual one."""


def _defined(module: str) -> Component:
    name = module.rpartition(".")[2]
    return getattr(import_module(f"{__package__}.{module}"), name.upper())


COMPONENTS: dict[str, Component] = {c.name: c for c in map(_defined, _MODULES)}


def component(name: str) -> Component:
    """The component of that name.

    Raises:
        StructureError: there is none.
    """
    try:
        return COMPONENTS[name]
    except KeyError:
        known = ", ".join(COMPONENTS)
        hint = meant(name, COMPONENTS)
        raise StructureError(f"there is no component '{name}'; {hint}there are: {known}") from None


def components_for(role: Role) -> tuple[Component, ...]:
    """The components that have a role; the first one is what is taken if nothing else is said."""
    return tuple(c for c in COMPONENTS.values() if role in c.declaration.roles)


def component_for(role: Role) -> Component:
    """The component that is taken for a role if nothing else is said.

    Raises:
        StructureError: no component has it.
    """
    for found in components_for(role):
        return found
    raise StructureError(f"no component is a {role}")

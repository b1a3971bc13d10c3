"""Compiled closures of one factory must not share a symbol between processes."""

from herringbone.components import (
    bearing_supports,
    bench_controller,
    drive_motor,
    load_motor,
    shaft_coupling,
    velocity_sensor,
)
from herringbone.components.gear_mesh import motion as gear_mesh

MODULES = (
    bearing_supports, bench_controller, drive_motor, gear_mesh, load_motor, shaft_coupling,
    velocity_sensor,
)  # fmt: skip


def test_each_component_has_a_stepper_of_its_own_name():
    """Numba derives symbols from qualified names; a counter of the process does not suffice.

    With equal names, caches filled by different processes made one component call another's step.
    """
    names = [module._advance.py_func.__qualname__ for module in MODULES]
    assert len(set(names)) == len(MODULES)
    for module, name in zip(MODULES, names, strict=True):
        declaration = module._d if hasattr(module, "_d") else module.at.DECLARATION
        assert name.startswith(declaration.name + ".")

"""Drivetrains of few parts, and what they are made of."""

from herringbone.core import Instance
from herringbone.cosim.structure.system import PartSpec, System

J1, J2, K, RATIO = 0.2, 3.0, 5e4, 2.5


def system(parts, *connections):
    """A system of `name: (component, values)`."""
    specs = tuple(PartSpec(name, c, values=values) for name, (c, values) in parts.items())
    return System("drivetrain", "", specs, tuple(connections))


def instance(component, **values):
    found = Instance(component, "part")
    for name, value in values.items():
        found.set(name.replace("__", "."), value)
    found.initialise()
    return found

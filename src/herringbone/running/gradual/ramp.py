"""Parts that let what loads a system rise, and over which time they do."""

from herringbone.components.registry import COMPONENTS
from herringbone.core.declaring.roles import Quantity
from herringbone.cosim.structure.system import System, Values

LOAD_RAMP_TIME = 0.02
"""Time over which the load rises in a gradual start [s]; the thesis discards its first 0.02 s."""


def ramps(system: System, time: float) -> Values:
    """Ramp times of all parts that have one: what users gave, or a time [s]."""
    return {path: given or time for path, given in ramp_times(system).items()}


def ramp_times(system: System) -> Values:
    """What users gave for the ramp times of all parts that have one; 0: nothing."""
    return {
        f"{part.name}.{ramp.name}": part.values.get(ramp.name) or 0.0
        for part in system.parts
        if part.component
        for ramp in COMPONENTS[part.component].declaration.offered(Quantity.LOAD_RAMP_TIME)
    }


def rising() -> list[str]:
    """Ramp times of all components that have one."""
    return [
        f"{name}.{ramp.name}"
        for name, kind in COMPONENTS.items()
        for ramp in kind.declaration.offered(Quantity.LOAD_RAMP_TIME)
    ]

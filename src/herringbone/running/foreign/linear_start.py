"""The start at which a system with foreign parts is linear, for what is predicted before a run."""

from contextlib import suppress

from herringbone.analysis.equilibrium import even_acceleration
from herringbone.analysis.rigid_rotation import names_of_states, rigid_rotation
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core import HerringboneError
from herringbone.cosim.structure.system import System
from herringbone.running.gradual.ramp import ramp_times
from herringbone.running.known_parts import known_parts
from herringbone.running.pairs.carrying_flank import loaded_start
from herringbone.running.pairs.mesh_phases import steady_values
from herringbone.running.pairs.open_flanges import loaded


def under_load(system: System) -> System:
    """The system with its own parts in steady rotation under load, as they are after a ramp.

    What foreign parts would feed is taken as zero; but gears that only these load have 200 N m at
    the pinion, so that their meshes are closed. Where nothing balances a load, as the motor is
    foreign, it speeds the drivetrain up evenly: teeth that carry nothing are softer, and have no
    damping. As it is where there is no such rotation either, or where it is in equilibrium with
    foreign parts, too.
    """
    if not system.foreign_parts or len(system.foreign_parts) == len(system.parts):
        return system
    if is_brought(system):
        return system
    steady = system.with_values(dict.fromkeys(ramp_times(system), 0.0))
    known = known_parts(steady)
    own = loaded(known)
    if own is not known:
        values = {
            f"{part.name}.{name}": value
            for part in own.parts
            for name, value in part.values.items()
        }
        steady = steady.with_values(values)
    for rotation in (steady_values, even_acceleration):
        with suppress(HerringboneError):
            return steady.with_values(loaded_start(own, rotation)[0])
    return system


def turned_back(system: System) -> System:
    """The system with its shafts turned back to angles near 0, where differences are exact.

    For matrices alone: in a run, foreign parts that are brought to the start would stand at angles
    that own shafts have left. As it is where none are brought.
    """
    if not is_brought(system):
        return system
    twin = Twin(known_parts(system))
    x = twin.state
    rates = twin.rhs(0.0, x)
    if (faster := rigid_rotation(twin, x)).any():  # also of shafts that begin to turn
        rates = twin.rhs(0.0, x + faster) - rates
    turning = [i for i in twin.turning if rates[i] != 0.0]
    if not turning:
        return system
    time = x[turning[0]] / rates[turning[0]]
    names = names_of_states(twin)
    return system.with_values({names[i]: float(x[i] - time * rates[i]) for i in turning})


def is_brought(system: System) -> bool:
    """True if it starts in equilibrium with foreign parts, which are stepped before."""
    return any(part.approach for part in system.parts)

"""How slowly the load rises where there is no start in equilibrium."""

from herringbone.analysis.modes.natural_modes import natural_modes
from herringbone.core import HerringboneError
from herringbone.cosim.structure.system import System
from herringbone.running.pairs.carrying_flank import loaded_start
from herringbone.running.pairs.open_flanges import loaded

LOAD_RAMP_TIME = 0.02
"""Time over which the load rises in a gradual start [s]; the thesis discards its first 0.02 s."""
_TORQUE = 200.0
"""At pinions that only foreign parts load [N m], so that meshes are closed."""
_SHARE = 0.5


def fitted_ramp(known: System, t_end: float) -> float:
    """One period of the slowest oscillation under load [s], within half of a run.

    A ramp of that length leaves about an eighth of the swing that one of 20 ms leaves on the test
    rig; see `LOAD_RAMP_TIME` for the shortest one.

    Args:
        known: the system without foreign parts, and without a ramp.
        t_end: of the run [s].
    """
    try:
        own = loaded(known, _TORQUE)
        modes = natural_modes(own.with_values(loaded_start(own)[0]))
    except HerringboneError:
        return LOAD_RAMP_TIME
    if not len(modes.frequency_hz):
        return LOAD_RAMP_TIME
    period = 1.0 / float(modes.frequency_hz[0])
    return max(LOAD_RAMP_TIME, min(period, _SHARE * t_end))

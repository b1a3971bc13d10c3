"""How slowly the load rises where there is no start in equilibrium."""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.modes.natural_modes import natural_modes
from herringbone.analysis.modes.slowest import slowest_oscillation
from herringbone.analysis.stability.linear_parts import linear_network
from herringbone.analysis.stability.surrogates.surrogate import PROMISED, Surrogate
from herringbone.core import HerringboneError
from herringbone.core.process.activity import activity
from herringbone.cosim.structure.system import System
from herringbone.running.foreign.linear_start import under_load
from herringbone.running.foreign.speeding_up import speeding_up
from herringbone.running.foreign.surrogates import Surrogates, opened_surrogates, without_missing
from herringbone.running.gradual.ramp import LOAD_RAMP_TIME
from herringbone.running.known_parts import known_parts
from herringbone.running.pairs.carrying_flank import loaded_start
from herringbone.running.pairs.open_flanges import loaded

_SHARE = 0.5


class Ramp(NamedTuple):
    """Over which time the load rises [s], and why, in words."""

    time: float
    why: str


def fitted_ramp(system: System, t_end: float, step: float | None) -> Ramp:
    """One period of the slowest oscillation under load, within half of a run.

    A ramp of that length leaves about an eighth of the swing that one of 20 ms leaves on the test
    rig; see `LOAD_RAMP_TIME` for the shortest one.

    Args:
        system: with its foreign parts, and without a ramp.
        t_end: of the run [s].
        step: of the trials that tell what stands for foreign parts [s]; None: the oscillation is
            that of the others alone.
    """
    with activity(f"looking for the slowest oscillation of {system.name}"):
        frequency, of = _slowest(system, step)
    if frequency is None:
        return Ramp(LOAD_RAMP_TIME, "no oscillation is known")
    told = f"the slowest oscillation{of} is at {frequency:.3g} Hz"
    fitting = max(LOAD_RAMP_TIME, min(1.0 / frequency, _SHARE * t_end))
    if fitting < 1.0 / frequency:
        return Ramp(fitting, f"{told}, of which half of the run is less than a period")
    return Ramp(fitting, told)


def _slowest(system: System, step: float | None) -> tuple[float | None, str]:
    """Frequency of the slowest oscillation [Hz], and of which parts it is, in words."""
    if step is not None:
        try:
            return _with_strangers(system, step)
        except (HerringboneError, np.linalg.LinAlgError):
            pass  # the words say what it is of
    try:
        own = loaded(known_parts(system))
        modes = natural_modes(own.with_values(loaded_start(own)[0]))
    except HerringboneError:
        return None, ""
    found = modes.frequency_hz
    return (float(found[0]) if len(found) else None), " without foreign parts"


def _with_strangers(system: System, step: float) -> tuple[float | None, str]:
    """See `_slowest`; raises HerringboneError, LinAlgError."""
    loaded_system = under_load(system)
    with opened_surrogates(loaded_system, step) as found:
        _leave_out_poor(found, step)
        known, _ = without_missing(loaded_system, found)
        known = speeding_up(known, found.strangers)
        network, members = linear_network(known, strangers=found.strangers)
        of = f" without {', '.join(found.missing)}" if found.missing else ""
        return slowest_oscillation(network, members), of


def _leave_out_poor(found: Surrogates, step: float) -> None:
    """Take what has a clock, or misses what the part does, for missing."""
    for name, stranger in list(found.strangers.items()):
        model = stranger.surrogate
        if not isinstance(model, Surrogate) or model.residual(step) > PROMISED:
            found.missing[name] = "no model in continuous time"
            del found.strangers[name]

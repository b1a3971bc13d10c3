"""A start in equilibrium of a system with foreign parts.

Nobody can set the states of a foreign FMU. But it can be stepped before the run begins, under the
inputs of the steady motion, until it answers steadily. What it answers then is what own parts are
balanced with; as what it is given follows from these, answers are looked for that come back.

Own parts turn by the angle by which foreign ones are turned on the way, so that the slowest of
these begins where it declares. Torques that do not balance speed the drivetrain up evenly, if no
controller holds the speed: parts settle under this acceleration, too. Where torques go with speed
(a slip, a propeller), the speed is moved to where they balance, near that which was set, or near
that at which own parts balance alone.
"""

from contextlib import suppress

from herringbone.core import HerringboneError
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.system import System
from herringbone.running.remembered_answers import start_of_known
from herringbone.running.settling.held import Wanted
from herringbone.running.settling.laid_out import laid_out
from herringbone.running.settling.search import PROBE, Search, SettledStart
from herringbone.running.settling.stranger import (
    NeverSettlesError,
    NoSettledStartError,
    Stranger,
)

_NEAR, _FARTHEST = 0.05, 0.5
"""How far a speed may be moved that was set, or at which own parts balance, as a share of it; the
latter where there is no other start."""


def settled_start(system: System, known: System, step: float, wanted: Wanted) -> SettledStart:
    """A start in equilibrium with all parts.

    Args:
        system: with all values.
        known: the same without foreign parts.
        step: of the trials that tell what foreign parts are [s].
        wanted: of the coupling.

    Raises:
        NeverSettlesError: there is none.
        NoSettledStartError: none was found, as a part failed, or cannot be tried.
    """
    try:
        with laid_out(system, known, step, wanted) as (network, strangers):
            return _found(known, network, strangers)
    except NeverSettlesError:
        raise
    except HerringboneError as error:
        raise NoSettledStartError(str(error)) from error


def _found(known: System, network: Network, strangers: list[Stranger]) -> SettledStart:
    """Where torques balance, near the speed that was set; else where those of own parts do.

    Else speeding up; else far from the speed that was set.
    """

    def balanced(farthest: float, known: System = known) -> SettledStart | None:
        with suppress(HerringboneError):
            return Search(known, network, strangers).at_balance(farthest)
        return None

    def balanced_alone() -> SettledStart | None:
        """A housing does not drive, and moves by little what others do."""
        speed = _own_speed(known, fastest) if (fastest := search.fastest) else None
        begin = speed and balanced(_NEAR, known.with_values({fastest: speed}))
        return begin._replace(given=search.given) if begin else None

    search = Search(known, network, strangers)
    try:
        found = search.found()
    except NoSettledStartError:
        if search.began and (start := balanced_alone() or balanced(_FARTHEST)):
            return start  # where nothing began it would fail alike
        raise
    if abs(found.acceleration) < PROBE:
        return found
    return balanced(_NEAR) or balanced_alone() or found


def _own_speed(known: System, fastest: str) -> float | None:
    """Speed [rad/s] at which own parts balance alone; None if they do not."""
    with suppress(HerringboneError):
        return float(start_of_known(known)[0][fastest])
    return None

"""How many steps the tests of flanges take, and what they leave out where runs are to be short.

Numbers of steps follow from flanges and from the longest run that is allowed alone, so that the
same is found on every machine; a clock only tells beforehand what the tests of a slow part cost.
"""

from collections.abc import Sequence

from herringbone.analysis.flange import rates, reaction, rotation, work
from herringbone.analysis.flange.bench import Bench
from herringbone.analysis.flange.variables import Flange
from herringbone.core.process.activity import lasting, tell
from herringbone.cosim.signature.cost import PATIENCE

OPTION = "--longest-trial"
_SHORT = 600.0
"""Time [s] that the tests of a slow part should not take; shorter runs are proposed for it."""


def longest_of() -> int:
    """Steps of the longest run that a test wants."""
    return work.CYCLES * max(work.PERIODS)


def tell_cost(bench: Bench, name: str) -> None:
    """Say before the tests of a slow part what they take, and what shorter ones would leave out."""
    seconds = bench.lab.seconds

    def cost(longest: int) -> str:
        count = steps(bench.flanges, longest)
        return f"about {count} steps, {lasting(count * seconds)}"

    if steps(bench.flanges, bench.longest) * seconds <= PATIENCE:
        return
    said = (
        f"{name} is slow, {seconds:.2g} s a step: the tests of what it must do take "
        f"{cost(bench.longest)}"
    )
    if shorter := _shorter(bench):
        without = ", ".join(left_out(bench, shorter))
        said += f"; with {OPTION} {shorter} {cost(shorter)}, without {without}"
    tell(said)


def left_out(bench: Bench, longest: int) -> list[str]:
    """What is not tested if no run may have more steps."""
    kept = work.kept(longest)
    lacking = [] if kept == work.PERIODS else ["passivity"]
    if kept and lacking:
        lacking = [f"passivity below {1.0 / (kept[-1] * bench.step):.3g} Hz"]
    if longest < rotation.LONGEST and not all(flange.takes_torque for flange in bench.flanges):
        lacking.append("the H-term after longer turns")
    if longest < reaction.TURN + reaction.HOLD and len(bench.flanges) > 1:
        lacking.append("action = reaction and relative motion")
    if longest < rates.SPIN:
        lacking.append("the angle over turns")
    return lacking


def _shorter(bench: Bench) -> int:
    """The longest run that makes tests quick enough, or the shortest useful one; 0: as it is."""
    ladder = [work.CYCLES * period for period in reversed(work.PERIODS)]
    lower = [n for n in ladder if n < bench.longest]
    fits = (n for n in lower if steps(bench.flanges, n) * bench.lab.seconds <= _SHORT)
    return next(fits, lower[-1] if lower else 0)


def steps(flanges: Sequence[Flange], longest: int) -> int:
    """Steps of all tests if no run may have more than `longest`; no test fails."""
    periods = work.kept(longest)
    count = work.CYCLES * (max(periods, default=0) + work.records(len(flanges)) * sum(periods))
    for flange in flanges:
        count += rates.SPIN if longest >= rates.SPIN else 0
        if flange.takes_torque:
            count += work.CYCLES * sum(periods[:: rates.EVERY])
            count += rotation.STEPS_OF_BODY
        else:
            count += rotation.STEPS_AT_ONCE
            count += rotation.STEPS_LATER if longest >= rotation.LONGEST else 0
    if len(flanges) > 1 and longest >= reaction.TURN + reaction.HOLD:
        count += reaction.RUNS * (reaction.TURN + reaction.HOLD)
    return count

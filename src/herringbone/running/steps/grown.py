"""A run that has grown beyond one with shorter steps: unstable, though it reached its end.

The energy of a coupling is watched where elements damp at the start; nothing damps in a clearance,
and foreign parts may have other names. What half the step gives tells it then. Nor does energy grow
without end where a motion of an unstable coupling comes to rest in a cycle, as where teeth part and
corrections no longer meet: these tell it, where the step was told to be unstable before.
"""

from collections.abc import Collection
from dataclasses import replace

from herringbone.analysis.accuracy.apart import Outgrown, outgrown
from herringbone.analysis.figures.settling import NOT_SETTLED
from herringbone.analysis.stability.instability import UNSTABLE_STEP
from herringbone.core import Outcome, OutcomeKind
from herringbone.core.wording import percent
from herringbone.cosim.algorithms.iterated import APART
from herringbone.cosim.structure.system import System
from herringbone.result.result import Result

_WRONG = 1.0
"""Error above which a run has little in common with those with other steps."""


class GrownError(Exception):
    """A run, or its beginning, has grown beyond one with shorter steps."""

    def __init__(self, found: Outgrown) -> None:
        self.found = found


def refuse_grown(run: Result, finer: Result, exchanged: Collection[str]) -> None:
    """Raise GrownError if a run has grown beyond one with half its step; see `outgrown`."""
    if (found := outgrown(run, finer, exchanged)) is not None:
        raise GrownError(found)


def as_unstable(result: Result, found: Outgrown) -> Result:
    """The run, ended as unstable: without budget, and without a line on whether it settles."""
    time, unit = result.outcome.time, result.units[found.output]
    message = (
        f"ran to {time:.4g} s, but {found.output} grows to {f'{found.value:.3g} {unit}'.strip()}, "
        f"and its group to {found.times:.2g} times the most that half the step gives: the coupling "
        f"or the model is unstable; use a step below {result.info.communication_step:g} s or an "
        "algorithm with a higher limit"
    )
    outcome = Outcome(OutcomeKind.UNSTABLE, time, found.output, message)
    return replace(_without_settling(result), outcome=outcome, budget=())


def with_doubt(result: Result, system: System) -> Result:
    """The result with a line where nothing tells that the coupling is stable, or much against it.

    Args:
        result: of a run with fixed steps, with its error by other steps if that was looked for.
        system: of the run.
    """
    info, known = result.info, result.verification
    if not system.connections or info.steps or not result.outcome.ended_well:
        return result
    if not system.foreign_parts:
        return _in_a_cycle(result)
    seen = "the energy of the coupling is not watched, as no element was seen to damp, and"
    if info.energy is not None:
        seen = "no energy was seen to grow by the coupling, but"
    elif known is None or not known.known:
        return result.noted(
            f"{seen} the error by other steps is not known: nothing tells whether the coupling is "
            "stable"
        )
    if known is None or not known.error > _WRONG:
        return result
    return _without_settling(result).noted(
        f"{seen} the error by other steps is {percent(known.error)}: the coupling may be unstable, "
        f"or the motion chaotic; compare with a step below {info.communication_step:g} s"
    )


def _in_a_cycle(result: Result) -> Result:
    """The result, ended as unstable if its step was told to be, and corrections did not meet."""
    lines = result.info.notes
    if not all(any(told in line for line in lines) for told in (UNSTABLE_STEP, APART)):
        return result
    time = result.outcome.time
    message = (
        f"ran to {time:.4g} s, but its step was told to be unstable, and corrections of the forces "
        "did not meet: the motion is one of the coupling; use a step below the limit, or an "
        "algorithm with a higher one; 'herringbone stability' shows them"
    )
    outcome = Outcome(OutcomeKind.UNSTABLE, time, message=message)
    result = _without_settling(result)
    info = replace(result.info, energy=None)  # that of a cycle does not grow, which is not "fine"
    return replace(result, outcome=outcome, budget=(), info=info)


def _without_settling(result: Result) -> Result:
    """No longer run is advised where the coupling is to blame."""
    notes = tuple(line for line in result.info.notes if not line.startswith(NOT_SETTLED))
    return replace(result, info=replace(result.info, notes=notes))

"""How a run ended: its outcome, whose doing it is, and what to do."""

import math
from typing import TYPE_CHECKING

from herringbone.core import Outcome, OutcomeKind
from herringbone.core.energy_report import Verdict
from herringbone.cosim.divergence import AS_BEFORE, broken_output, diverged
from herringbone.cosim.loops.adaptive_step.loop import STEP_LIMIT
from herringbone.cosim.loops.common import COUPLING_FAILED, DONE, NOT_FINITE, PART_FAILED

if TYPE_CHECKING:
    from herringbone.cosim.run import Run

REFUSED = -1
"""Status of a run in which a part refuses a value of another type than real."""
_PROBLEMS = {
    COUPLING_FAILED: OutcomeKind.COUPLING_FAILED,
    STEP_LIMIT: OutcomeKind.STEP_LIMIT,
}
_BEGUN = 8
"""Macro steps of which nobody can say whether something has grown."""
_GROWN = 1e6
"""Growth by which a part's refusal is the coupling's doing: one that goes back from the step shows
no value that is not finite."""


class Ending:
    """A run that goes no further.

    Args:
        run: its parts are still there.
        done: steps of its grid.
    """

    def __init__(self, run: "Run", done: int) -> None:
        self._run, self._done = run, done
        self._reached = done * run.grid.step

    def outcome(self, status: int, culprit: int) -> Outcome:
        """What it comes to.

        Args:
            status: of the loop, or REFUSED.
            culprit: number of the part that ended it, if one did.
        """
        run, reached = self._run, self._reached
        if status == DONE:
            complete = self._done == run.grid.count
            return self._at_end() if complete else Outcome.interrupted(reached)
        if (end := self._asked_for(status, culprit)) is not None:
            late = reached - run.grid.step < end.time  # a cell tells of a step with the next one
            time = end.time if late else reached
            return Outcome(end.kind, time, end.culprit, end.message)
        if status == REFUSED:
            message = f"{run.refusal}, at {reached:g} s"
            return Outcome(OutcomeKind.PART_FAILED, reached, run.others.asked, message)
        return self._failure(status, culprit)

    def _at_end(self) -> Outcome:
        """Completed, unless the coupling was seen to add energy without end."""
        energy = self._run.watch.report()
        if energy is None or energy.verdict is not Verdict.UNSTABLE:
            return self._with_rows()
        bond = energy.bond or ""
        message = (
            f"ran to the end, but the coupling is unstable from {energy.time:.4g} s, most of all "
            f"at {bond}: use a step below {self._run.mean_step(self._done):g} s or an algorithm "
            "with a higher limit"
        )
        return Outcome(OutcomeKind.UNSTABLE, self._reached, bond, message)

    def _with_rows(self) -> Outcome:
        """Completed, with or without outputs that are no numbers."""
        if (found := self._run.rows.first_nan(self._done)) is None:
            return Outcome(OutcomeKind.COMPLETED, self._reached)
        where, since = found
        message = f"{where} is NaN from {since:g} s on; no part takes it, and all else is complete"
        return Outcome(OutcomeKind.WITH_NAN, self._reached, where, message)

    def _asked_for(self, status: int, culprit: int) -> Outcome | None:
        """The end that a part asked for; None if none did."""
        every = self._run.network.parts
        asked = {
            PART_FAILED: every[culprit : culprit + 1],
            REFUSED: [part for part in every if part.name == self._run.others.asked],
            COUPLING_FAILED: every,
        }
        for part in asked.get(status, ()):
            if (end := part.ended()) is not None:
                message = f"{part.name} ended the simulation at {end:g} s"
                return Outcome(OutcomeKind.ENDED, end, part.name, message)
        return None

    def _failure(self, status: int, culprit: int) -> Outcome:
        """A part refused its step, or its values have diverged."""
        run, reached = self._run, self._reached
        if (broken := broken_output(run.network)) is not None:
            return self._not_finite(broken)
        if status in _PROBLEMS:
            return Outcome(_PROBLEMS[status], reached, run.prepared.culprit, run.prepared.problem)
        part = run.network.parts[culprit]
        part.failed()
        said = "; ".join(part.messages())
        where, value = diverged(run.network, culprit)
        if where and not math.isfinite(value):
            return self._not_finite(where)
        if status == PART_FAILED and not where and (run.rows.growth(self._done) or 0.0) > _GROWN:
            where = part.name
        if status == NOT_FINITE or where:
            return self._diverged(where or part.name, "grows beyond all bounds")
        message = f"{part.name} refused its step at {reached:g} s" + (f": {said}" if said else "")
        return Outcome(OutcomeKind.PART_FAILED, reached, part.name, message)

    def _not_finite(self, where: str) -> Outcome:
        """A value is not finite: the part's doing, unless something has grown before."""
        how = "is not finite"
        grown = self._run.rows.growth(self._done)
        if grown is not None and grown <= AS_BEFORE:
            why = ", and nothing has grown before"
        elif self._done <= _BEGUN:
            why = (
                ", as soon as the run has begun: look into that part and its start values, or use "
                "a shorter step"
            )
        else:
            return self._diverged(where, how)
        message = f"{where} {how} at {self._reached:g} s{why}"
        return Outcome(OutcomeKind.PART_FAILED, self._reached, where, message)

    def _diverged(self, where: str, how: str) -> Outcome:
        """Values have grown until they are beyond all bounds."""
        message = (
            f"{where} {how} at {self._reached:g} s; the coupling or the model is unstable: "
            f"use a step below {self._run.mean_step(self._done):g} s or an algorithm with a higher "
            "limit"
        )
        return Outcome(OutcomeKind.DIVERGED, self._reached, where, message)

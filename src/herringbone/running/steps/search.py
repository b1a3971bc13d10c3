"""Runs with ever shorter steps: what is known of their errors, and when there are enough."""

from dataclasses import replace
from fractions import Fraction
from statistics import fmean

from herringbone.analysis.accuracy.apart import Apart, apart
from herringbone.analysis.accuracy.step_power import FAR, left, left_of
from herringbone.core import Outcome, OutcomeKind
from herringbone.result.verification import Verification
from herringbone.running.coupled import Coupled
from herringbone.running.steps.tried_run import TriedRun

_RUNS, _FAILURES, _REFUSALS = 20, 2, 12
"""Runs in all; runs in which a part or the coupling fails beside one that ended well, or twice at
the same time; runs that fail as long as none ended well: down to 1/2000 of the first step."""
_AT_ONCE = 4
"""A step is divided by this whole number at the most, so that the next run has all its points."""
_FEW, _CLOSEST = (1, 2, 4), Fraction(3, 2)
"""Of so many steps of a run the next one makes more: half as many again at the least."""
_AIM = 0.7
"""Share of the tolerance that the next step is to err."""
_PRESUMED, _KNOWN = 4.0, 3
"""Power that the next step is chosen by, until so many runs are near their predecessors; then it is
the larger one of the last two measured. The first that is measured is that of the longest steps,
and by a low one the next step would be far too short. One that presumes too much costs one more
run, no accuracy: what was measured tells the error."""
_LOWEST = 0.5
"""Of these powers."""
_FAR_BELOW = 0.1
"""Share of a tolerance below which it is told why no longer step was taken."""
_BLIND = 2.0
"""What the step is divided by as long as nothing is known of the error."""
_FALLS = 0.3
"""Power below which the difference of two runs does not fall with their steps. Two such runs near
each other tell, or four that are far apart, as those are where long steps are nearly unstable or
far longer than a contact; of noise, whose differences rise and fall, the mean of four."""
_LONG = 4
_PATIENCE, _TIMES = 60.0, 30.0
"""A run is not begun if it takes longer [s], and so many times as long as all before."""


class Search:
    """Runs that were tried, and why the search ends.

    Args:
        tolerance: relative error.
        wished: it is the user's own.

    Attributes:
        tried: runs that ended well.
        failed: steps of others [s], and how they ended.
        why: the search is over; "" while it is not.
    """

    def __init__(self, tolerance: float, *, wished: bool) -> None:
        self._tolerance, self._wished = tolerance, wished
        self.tried: list[TriedRun] = []
        self.failed: list[tuple[float, Outcome]] = []
        self.why = ""
        self._seconds, self._steps = 0.0, 1

    def take(self, found: Coupled) -> None:
        """Add a run."""
        outcome = found.result.outcome
        self._steps = round(found.result.info.t_end / found.recording.step)
        self._seconds += found.recording.wall_seconds
        if outcome.ended_well:
            self.tried.append(self._judged(found))
        else:
            self.failed.append((found.recording.step, outcome))
        self.why = self._over(outcome, found)

    def pieces(self) -> Fraction:
        """By what to divide the last step so that it errs the share of the tolerance aimed at.

        A whole number of the new steps makes a few of the last ones, so that both runs have points
        in common, and the whole run.
        """
        wanted, count = self._shorter(), self._steps
        found = (
            Fraction(many, few)
            for few in _FEW
            for many in range(few, _AT_ONCE * few + 1)
            if count % few == 0 and _CLOSEST * few <= many and wanted * few <= many
        )
        return min(found, default=Fraction(_AT_ONCE))

    @property
    def _power_known(self) -> bool:
        return sum(tried.apart <= FAR for tried in self.tried) >= _KNOWN

    def _shorter(self) -> float:
        """By what the last step is too long, by powers as far as these are known."""
        if not self.tried or self.tried[-1].apart > FAR:
            return _BLIND
        before, last, power = *self.tried[-2:], _PRESUMED
        if self._power_known:  # one that is low by chance, as with contacts, is no reason
            power = min(max(before.power, last.power, _LOWEST), _PRESUMED)
        error = last.apart * left_of(before.step, last.step, power)
        return (error / (_AIM * self._tolerance)) ** (1.0 / power)

    def _judged(self, found: Coupled) -> TriedRun:
        """A run beside those before."""
        if not self.tried:
            return TriedRun(found)
        before = self.tried[-1]
        differences = apart(before.found.every, found.every, found.exchanged)
        steps = (*(tried.step for tried in self.tried), found.recording.step)
        earlier = before.differences.groups if before.differences else {}
        powers = {name: group.power for name, group in before.groups.items()}
        groups = {
            name: left(earlier.get(name), difference, steps, powers.get(name, 0.0))
            for name, difference in differences.groups.items()
        }
        return TriedRun(found, differences, groups)

    def _over(self, outcome: Outcome, found: Coupled) -> str:
        """Why no other step is tried; "" if one is."""
        patience = 2 if self.tried and self.tried[-1].apart < FAR else _LONG
        powers = [t.power for t in self.tried[2:]]
        flat = len(powers) >= patience and all(p < _FALLS for p in powers[-patience:])
        flat = flat or (len(powers) >= _LONG and fmean(powers[-_LONG:]) < _FALLS)
        lost = not outcome.ended_well and not outcome.unstable and self._failed_for_good()
        reasons = {
            "the run with a shorter step was interrupted": outcome.kind is OutcomeKind.INTERRUPTED,
            outcome.message: lost,
            "met": outcome.ended_well and self.tried[-1].error <= self._tolerance,
            "the differences do not fall with the step, as with noise or jumps": flat,
            f"{_RUNS} runs were made": len(self.tried) + len(self.failed) >= _RUNS,
        }
        why = next((reason for reason, holds in reasons.items() if holds), "")
        return why or self._too_dear(found)

    def _failed_for_good(self) -> bool:
        """No shorter step helps: the last one failed where that before did, or others do not."""
        if self.tried or len(self.failed) < _FAILURES:
            return len(self.failed) >= _FAILURES
        (step, before), (_, last) = self.failed[-2:]
        alike = last.time > 0.0 and abs(last.time - before.time) <= step
        return alike or len(self.failed) >= _REFUSALS

    def _too_dear(self, found: Coupled) -> str:
        """Why the step that is needed is not begun; "" if it is."""
        if not self._power_known or self.tried[-1].apart > FAR:
            return ""
        times = self._shorter()
        seconds = times * found.recording.wall_seconds
        if seconds < max(_PATIENCE, _TIMES * self._seconds):
            return ""
        step = f"{found.recording.step / times:.2g}"
        return (
            f"the error falls with the power {self.tried[-1].power:.2g} of the step, as where an "
            f"FMU's own integration changes with it; steps of {step} s would take {seconds:.2g} s, "
            f"and are tried with --step {step}"
        )

    def told(self) -> Coupled:
        """The last run that ended well, with its verification and a note."""
        last, runs = self.tried[-1], len(self.tried) + len(self.failed)
        result, found = last.found.result, last.differences
        size = f"error {last.error:.2g}, " if found else ""
        note = f"tolerance = {self._tolerance:g}: steps of {last.step:g} s, {size}runs: {runs}"
        notes = (*result.info.notes, note + self._limit())
        result = replace(result, info=replace(result.info, notes=notes))
        if self._wished or found:
            result = replace(result, verification=self._verification(found))
        if said := self._headline():
            message = "; ".join(filter(None, (result.outcome.message, said)))
            result = replace(result, outcome=replace(result.outcome, message=message))
        return last.found._replace(result=result)

    def _headline(self) -> str:
        """That the tolerance is not met, or that nobody knows; "" if it is."""
        last, asked = self.tried[-1], f"tolerance = {self._tolerance:g}"
        if last.differences is None:
            return f"whether {asked} is met is not known: {self.why}" if self._wished else ""
        missed = last.error > self._tolerance
        return f"{asked} is not met: error {last.error:.2g}; {self.why}" if missed else ""

    def _verification(self, found: Apart | None) -> Verification:
        """Of the last run; its worst output as its worst group, of which more is known."""
        last = self.tried[-1]
        asked = self._tolerance if self._wished else None
        if found is None:
            how = "no other run ended well"
            return Verification({}, "", 0.0, last.step, how, asked, known=False)
        groups = {name: group.error for name, group in last.groups.items()}
        worst = last.error / last.apart * found.worst_difference if last.apart else 0.0
        step = self.tried[-2].step
        return Verification(groups, found.worst, worst, step, "by longer steps", asked)

    def _longer_failed(self) -> str:
        """The shortest step that failed, of those longer than that of the first good run."""
        longer = [failed for failed in self.failed if failed[0] > self.tried[0].step]
        if not longer:
            return ""
        step, outcome = min(longer, key=lambda failed: failed[0])
        return f"{step:g} s is not stable" if outcome.unstable else f"{step:g} s fails"

    def _limit(self) -> str:
        """What kept the search from the tolerance, if anything did."""
        last = self.tried[-1]
        if last.differences is None:
            return f"; its error is not known: {self.why}"
        if last.error > self._tolerance:
            return f"; not met: {self.why}"
        longer = self._longer_failed()
        if len(self.tried) > 2:
            if last.error > _FAR_BELOW * self._tolerance:
                return ""
            before = self.tried[-2]
            also = f", and {longer}" if longer else ""
            return f"; with {before.step:g} s it was not seen to be met: {before.error:.2g}{also}"
        why = longer or "no longer one is tried"
        return f"; a step longer than {self.tried[0].step:g} s is of no use here: {why}"

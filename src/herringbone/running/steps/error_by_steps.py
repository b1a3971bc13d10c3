r"""The error of a run with foreign parts, told unasked: by runs with half and with twice the step.

With an error C h^p the run and the one with 2 h differ by d = C h^p (2^p - 1), the one with h / 2
and the run by C h^p (1 - 2^-p), which is d / r with r = 2^p: so the error is d / (r - 1). That of
first order, 2 d / r, is taken where r is below 2.

Longer steps alone do not tell: an FMU's inner steps that follow the macro step up to a longest one
change with shorter ones only, and what errs with the first power then is not seen at all. Power and
error are those of each group, as parts differ in both.

Half a step costs twice the run. It is taken over the first quarter, which tells r, and over the
whole run where that does not tell: what twice the step changes there is not what it changes in all,
as where contacts part later or a start dies out; or r is below 2. Where parts take no half step,
the runs with 2 h and 4 h tell r.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from herringbone.analysis.accuracy.apart import Apart, apart
from herringbone.core import HerringboneError, Outcome, OutcomeKind
from herringbone.cosim.structure.system import System
from herringbone.result.result import TIME, Result
from herringbone.result.verification import Verification, error_unknown
from herringbone.running.coupled import Coupled
from herringbone.running.coupling_choice import Asked
from herringbone.running.reporting.run_result import with_coupling_row
from herringbone.running.steps.grown import GrownError, as_unstable, refuse_grown
from herringbone.running.steps.verification import scaled, with_half_step, with_step
from herringbone.scenes import Scene

_PART, _FEWEST = 4, 16
"""Half the step is taken over a quarter of the run, and so many rows at the least."""
_FADED, _GROWN, _MATTERS = 0.4, 2.0, 0.2
"""Differences of the whole run over those of its first part, between which that one tells (what is
there at the start only makes half in all); share of the largest error up to which a group does not
count for it."""
_FALL, _LEAST, _MOST = 8.0, 2.0, 16.0
"""Of differences as the step is halved: third order if nothing is known; least, and most as far as
longer steps tell it."""
_STAYS = 2.0**0.5
"""Fall below which differences do not fall with the step: of half an order."""
_SAME = 1e-9


def can_be_verified(system: System, result: Result, found: Coupled, asked: Asked) -> bool:
    """True if nothing is known of a run's error yet, no rule tells it, and trials are allowed."""
    return (
        bool(system.foreign_parts and system.connections)
        and asked.probe
        and not found.algorithm.adaptive
        and result.verification is None
        and result.outcome.ended_well
    )


def verified_by_other_steps(
    result: Result, system: System, scene: Scene, found: Coupled, asked: Asked
) -> Result:
    """The result with its error by other steps, which cost once to twice and a half as much again.

    It is unstable if it has grown beyond the run with half the step.

    Args:
        result: of the run.
        system, scene: of the run.
        found: the run.
        asked: how it was asked for.
    """
    if found.once:
        return result.noted(
            "the error is not known: an FMU can be instantiated once only, and runs in this "
            "process; in child processes (on Linux, without --in-process) it is told"
        )
    others = _Others(result, system, scene, found, asked)
    try:
        twice = others.run(2.0)
        verification = others.by_half(twice) or others.by_longer(twice)
    except _StoppedError as stopped:
        return result.noted(error_unknown(stopped.outcome, "a run with another step"))
    except GrownError as grown:
        return as_unstable(result, grown.found)
    if verification is None:
        return result.noted(
            "the error is not known: with half the step and with twice the step no run ends well"
        )
    return with_coupling_row(replace(result, verification=verification))


class _StoppedError(Exception):
    """The user has stopped a run with another step, and waits for no further one."""

    def __init__(self, outcome: Outcome) -> None:
        self.outcome = outcome


@dataclass(frozen=True)
class _Others:
    """Runs like one, with other steps; see `verified_by_other_steps`."""

    result: Result
    system: System
    scene: Scene
    found: Coupled
    asked: Asked

    def by_half(self, twice: Result | None) -> Verification | None:
        """By half and twice the step; None if parts do not take half of it.

        Args:
            twice: the run with twice the step; None if that does not end well.
        """
        end, step = self.scene.t_end, 0.5 * self.found.recording.step
        if twice is None:
            shorter, how = self._halved(end), "by half the macro step, third order assumed"
            return shorter and scaled(shorter, _FALL / (_FALL - 1.0), step, how)
        longer, how = self._apart(twice, self.result), "by half and twice the macro step"
        first = self._first_part()
        if first < end and (own := self._own(first)) is not None:
            begun, shorter = self._apart(_until(twice, first), own), self._halved(first, own)
            if shorter is None:
                return None
            falls = _falls(begun.groups, shorter.groups)
            told = _by_falls(longer, falls, step, how)
            if _tell(told.groups, falls, begun.groups, longer.groups):
                return told
        shorter = self._halved(end)
        return shorter and _by_falls(longer, _falls(longer.groups, shorter.groups), step, how)

    def by_longer(self, twice: Result | None) -> Verification | None:
        """By twice and four times the step; None if no run takes these; see `by_half`."""
        if twice is None:
            return None
        longer, longest, falls = self._apart(twice, self.result), self.run(4.0), {}
        how = "by twice the macro step, third order assumed"
        if longest is not None:
            found = _falls(self._apart(longest, twice).groups, longer.groups)
            falls = {name: min(max(fall, _LEAST), _MOST) for name, fall in found.items()}
            how = "by two and four times the macro step"
        return _by_falls(longer, falls, 2.0 * self.found.recording.step, how)

    def run(self, times: float, end: float | None = None) -> Result | None:
        """The run with another step up to a time [s]; None if it does not end well.

        Raises:
            _StoppedError: by the user.
        """
        step, scene = times * self.found.recording.step, self.scene
        scene = replace(scene, t_end=end or scene.t_end)
        if step > scene.t_end:
            return None
        try:
            if times < 1.0:
                found = with_half_step(self.system, scene, self.found, self.asked)
            else:
                found = with_step(self.system, scene, self.found, self.asked, step)
        except HerringboneError:  # no reason to lose a run that has ended
            return None
        outcome = found.result.outcome
        if outcome.kind is OutcomeKind.INTERRUPTED:
            raise _StoppedError(outcome)
        return found.result if outcome.ended_well else None

    def _halved(self, end: float, own: Result | None = None) -> Apart | None:
        """Differences from the run with half the step up to a time [s]; None: it is not taken.

        Raises:
            GrownError: the run has grown beyond that one.
        """
        half, own = self.run(0.5, end), own or self.result
        if half is None:
            return None
        refuse_grown(own, half, self.found.exchanged)
        return self._apart(own, half)

    def _first_part(self) -> float:
        """End of the part over which half the step is taken first [s]."""
        record_step = self.found.recording.record_step
        rows = round(self.scene.t_end / record_step)
        return min(max(rows // _PART, _FEWEST) * record_step, self.scene.t_end)

    def _own(self, end: float) -> Result | None:
        """The run up to a time [s]: it is made again where memory has its last rows only."""
        if self.result.data[TIME].iloc[0] == 0.0:
            return _until(self.result, end)
        return self.run(1.0, end)

    def _apart(self, first: Result, second: Result) -> Apart:
        return apart(first, second, self.found.exchanged)


def _until(result: Result, end: float) -> Result:
    """Rows up to a time [s]."""
    time = result.data[TIME].to_numpy()
    return replace(result, data=result.data[time <= end * (1.0 + _SAME)])


def _tell(
    errors: Mapping[str, float],
    falls: Mapping[str, float],
    begun: Mapping[str, float],
    whole: Mapping[str, float],
) -> bool:
    """True if the first part tells the errors of the whole run.

    Differences there are as large as in all, and fall with the step, in all groups that matter.
    """
    large = _MATTERS * max(errors.values(), default=0.0)
    return all(
        _FADED * begun.get(name, 0.0) <= whole[name] <= _GROWN * begun.get(name, 0.0)
        and falls.get(name, _FALL) >= _LEAST
        for name, error in errors.items()
        if error > large
    )


def _falls(longer: Mapping[str, float], shorter: Mapping[str, float]) -> dict[str, float]:
    """By what the difference of each group falls as both steps are halved."""
    return {name: longer[name] / d for name, d in shorter.items() if d and name in longer}


def _by_falls(longer: Apart, falls: Mapping[str, float], step: float, how: str) -> Verification:
    """Errors by differences from the run with twice the step, and by what these fall.

    Of the worst output as of the group that errs most, of which more is known.
    """
    shares = {name: _share(falls.get(name, _FALL)) for name in longer.groups}
    groups = {name: shares[name] * d for name, d in longer.groups.items()}
    worst = max(groups, key=groups.__getitem__, default="")
    share = shares.get(worst, _share(_FALL))
    if (fall := falls.get(worst, _FALL)) < _STAYS:
        how += (
            f", between which differences fall by {fall:.2g} only, as with jumps, noise or inner "
            "steps at their longest: it may be off by an order of magnitude"
        )
    return Verification(groups, longer.worst, share * longer.worst_difference, step, how)


def _share(fall: float) -> float:
    """Error over the difference from the run with twice the step."""
    return 1.0 / (fall - 1.0) if fall >= _LEAST else _LEAST / max(fall, _SAME)

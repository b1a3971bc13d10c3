"""The ladder of leaner models, with estimates of what each errs, before any of them is solved."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from herringbone.analysis.leaner.cuts import Cut, cuts_of, modes_of
from herringbone.analysis.leaner.estimate import Estimates
from herringbone.analysis.leaner.question import Apart, Question
from herringbone.analysis.steady.operating_point import Point
from herringbone.analysis.steady.solver import SteadySolver
from herringbone.analysis.steady.state import SteadyState
from herringbone.analysis.steady.structure import Structure
from herringbone.core.lean import Lean
from herringbone.scenes.asking import SHARE
from herringbone.studies.planning.rung import STEADY, Rung, Worst, worst

_STAIRS = 5
"""Rungs of modes that are listed."""
_SAFE = 0.8
"""Of the share of the tolerance that a model may err: probes are not the whole range."""


class Ladder:
    """Leaner models at some probed motions.

    Args:
        solver: of the whole model.
        states: its motions at the probes.
        questions: what is asked.
    """

    def __init__(
        self, solver: SteadySolver, states: Sequence[SteadyState], questions: Sequence[Question]
    ) -> None:
        self._solver, self._states, self._questions = solver, states, questions
        self._cuts = cuts_of(solver.structure)
        self._pairs = modes_of(solver.structure)
        names = [name for pair in self._pairs for name in pair]
        names += [name for cut in self._cuts for name in cut.lean.hold]
        names = list(dict.fromkeys(names))
        self._estimates = [Estimates(state, questions, names) for state in states]
        self.modes = self._by_influence()

    def _by_influence(self) -> list[tuple[str, str]]:
        """Modes that move, by what they do to what is asked, least first."""
        rates = [pair[1] for pair in self._pairs]
        sizes: dict[str, float] = {}
        for estimates in self._estimates:
            for rate, size in estimates.influences(rates).items():
                sizes[rate] = max(size, sizes.get(rate, 0.0))
        own = [pair for pair in self._pairs if pair[1] in sizes]
        return sorted(own, key=lambda pair: sizes[pair[1]])

    def estimate(self, lean: Lean) -> Worst:
        """The worst error of a leaner model at the probes."""
        return worst(self._questions, self._errors(lean))

    def _errors(self, lean: Lean) -> Iterator[tuple[Point, Mapping[str, Apart]]]:
        leaner = dict[Structure, Structure]()
        for state, estimates in zip(self._states, self._estimates, strict=True):
            if lean.only_held:
                by_name = estimates.held(lean.hold)
            else:
                own = state.structure  # most points share one
                if own not in leaner:
                    leaner[own] = own.leaner(lean)
                by_name = estimates.of(leaner[own])
            yield state.point, by_name

    def _fits(self, lean: Lean) -> bool:
        """True if a model errs little enough at all probes; the first at which not tells."""
        return all(
            worst(self._questions, [each]).ratio <= _SAFE * SHARE for each in self._errors(lean)
        )

    def without(self, count: int) -> Lean:
        """The model without the modes that matter least."""
        return Lean(tuple(name for pair in self.modes[:count] for name in pair))

    def rungs(self, *, for_fmu: bool = False) -> Iterator[Rung]:
        """Leaner models, those that leave out least first; of an FMU such as follow set points."""
        total = len(self.modes)
        counts = {round(total * k / _STAIRS) for k in range(1, _STAIRS)} - {0, total}
        most = self._most() if total else 0
        for count in sorted(counts | ({most} if most else set())):
            name = f"{total - count} of {total} modes, by influence"
            yield self._rung(name, self.without(count))
        for cut in self._cuts:
            if for_fmu and cut.steady:
                continue
            rung = self._rung(cut.name, cut.lean)
            yield rung
            if most and self.allowed(rung) and cut.lean.only_held:
                yield self._both(cut, most, total)

    def by_hand(self, lean: Lean) -> Rung:
        """A leaner model that the user gave."""
        return self._rung("by hand, as the scene has it", lean)

    def _both(self, cut: Cut, most: int, total: int) -> Rung:
        name = f"{cut.name}, {total - most} of {total} modes"
        return self._rung(name, cut.lean | self.without(most))

    def allowed(self, rung: Rung) -> bool:
        """True if the estimate leaves the solver its share, and no law is frozen that bends."""
        good = rung.estimate is not None and rung.estimate.ratio <= _SAFE * SHARE
        return good and not frozen_where_they_bend(rung.lean, self._states)

    def _most(self) -> int:
        """How many modes can go, by halving the interval."""
        low, high = 0, len(self.modes)
        while high - low > 1:
            middle = (low + high) // 2
            if self._fits(self.without(middle)):
                low = middle
            else:
                high = middle
        return low

    def _rung(self, name: str, lean: Lean) -> Rung:
        rung = Rung(name, STEADY, lean, self.estimate(lean))
        if frozen_where_they_bend(lean, self._states):
            return replace(rung, why="its laws bend, as teeth that separate do")
        if not self.allowed(rung):
            return replace(rung, why=f"its estimate is above {_SAFE * SHARE:g} of the tolerance")
        return rung


def frozen_where_they_bend(lean: Lean, states: Sequence[SteadyState]) -> bool:
    """True if a model freezes laws of a part that bend in one of the motions of the whole one."""
    own = set(lean.straight)
    return bool(own) and any(own & set(state.bends) for state in states)

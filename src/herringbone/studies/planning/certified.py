"""Certifying leaner models: lean and whole, solved at the same points, and what each costs."""

import time
from collections.abc import Sequence

import numpy as np

from herringbone.analysis.leaner.question import Apart, Question, apart, lines_of, nothing_asked
from herringbone.analysis.steady.operating_point import Point
from herringbone.analysis.steady.solver import SteadySolver
from herringbone.analysis.steady.state import SteadyState
from herringbone.core import ParameterError
from herringbone.core.lean import WHOLE, Lean
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.scenes.asking import LEAST, SHARE
from herringbone.studies.planning.rung import Worst, worst

FINER = 20.0
"""How much finer than the tolerance models are compared."""
_LEAST, _LOOSEST = SHARE * LEAST, 0.05
"""Tolerances of a solver."""
_TIGHTER, _LOWER = 4, 0.2
"""How often a solver's tolerance is lowered, and by what."""
_TIMES, _PRICED = 3, 6
"""Turns in which costs are measured, and at how many of the points."""


def tolerance_for(questions: Sequence[Question], share: float) -> float:
    """What a solver needs for all questions, with a share of their tolerances."""
    wanted = share * min(question.tolerance for question in questions)
    return min(_LOOSEST, max(_LEAST, wanted))


class Certifier:
    """Whole and leaner models at the test points.

    Args:
        solver: of the whole model.
        questions: what is asked.
        points: where it is tested.
        share: of the tolerance, for the solver.

    Attributes:
        states: of the whole model, by point.
        lines: of these, by question.
        fine, tolerance: with which models are compared, and with which questions are answered.

    Raises:
        ParameterError: the whole model has no steady state at a point, or at no point a line that
            is asked for.
    """

    def __init__(
        self,
        solver: SteadySolver,
        questions: Sequence[Question],
        points: Sequence[Point],
        share: float,
    ) -> None:
        self.questions, self.points = questions, points
        self.fine = tolerance_for(questions, 1.0 / FINER)
        self.tolerance = tolerance_for(questions, share)
        self._solver = solver.leaner(WHOLE, self.fine)
        self._known: dict[Lean, SteadySolver] = {WHOLE: self._solver}
        self.states = [found for found in self._solved(self._solver, ()) if found is not None]
        if len(self.states) < len(points):
            raise ParameterError(
                "plan: the system has no steady state that was found at all of the operating "
                "points; narrow the range, or ask for a transient"
            )
        self.lines = [
            {question.name: lines_of(state, question) for question in questions}
            for state in self.states
        ]
        self._refuse_nothing()
        self._tighten(share)

    def _refuse_nothing(self) -> None:
        """Refuse what has no line at any point, which every model would answer without error."""
        for question in self.questions:
            why = [nothing_asked(question, lines[question.name]) for lines in self.lines]
            if all(why):
                raise ParameterError(f"ask: {question.name}: {why[0]}")

    def _tighten(self, share: float) -> None:
        """Lower the solver's tolerance, which is of groups of channels, until questions meet it."""
        for _ in range(_TIGHTER):
            states = self._solved(self.solver(WHOLE, self.tolerance), ())
            found = self._worst(states)
            if (found and found.ratio <= share) or self.tolerance <= self.fine:
                return
            self.tolerance = max(self.fine, _LOWER * self.tolerance)

    def _solved(
        self, solver: SteadySolver, near: Sequence[SteadyState]
    ) -> list[SteadyState | None]:
        found: list[SteadyState | None] = []
        last: SteadyState | None = None
        for k, point in enumerate(self.points):
            state = solver.solve(point, near[k] if near else last)
            last = state if state.converged else None
            found.append(last)
        return found

    def solver(self, lean: Lean, tolerance: float) -> SteadySolver:
        """What solves for a leaner model."""
        if lean not in self._known:
            self._known[lean] = self._solver.leaner(lean)
        return self._known[lean].leaner(WHOLE, tolerance)

    def error(self, lean: Lean) -> Worst | None:
        """The worst error of a leaner model; None if it has no steady state at a point."""
        return self._worst(self._solved(self.solver(lean, self.fine), self.states))

    def _worst(self, states: Sequence[SteadyState | None]) -> Worst | None:
        """The worst error of states at the points; None if one of them is not there."""
        found: list[tuple[Point, dict[str, Apart]]] = []
        for ours, theirs in zip(states, self.lines, strict=True):
            if ours is None:
                return None
            by_name = {q.name: apart(q, lines_of(ours, q), theirs[q.name]) for q in self.questions}
            found.append((ours.point, by_name))
        return worst(self.questions, found)

    def costs(
        self, models: Sequence[Lean], rounds: int = _TIMES, most: int = _PRICED
    ) -> list[float]:
        """CPU time of an answer by each model [s]: geometric means over the points, by turns.

        Of several points each state is found from the one before; of a point that is asked for
        again, the least time counts. How many iterations a point takes goes up and down from
        model to model, so that a median of few points would be chance, and a mean the noise of one.
        """
        solvers = [self.solver(lean, self.tolerance) for lean in models]
        points = self.points[:: -(-len(self.points) // most)]
        spent = np.full((rounds, len(models), len(points)), np.inf)
        with one_blas_thread():
            for turn in range(rounds):
                near: list[SteadyState | None] = [None] * len(models)
                for k, point in enumerate(points):
                    for m, solver in enumerate(solvers):
                        start = time.thread_time()
                        found = solver.solve(point, near[m])
                        spent[turn, m, k] = time.thread_time() - start
                        near[m] = found if found.converged else None
        first = 1 if len(points) > 1 else 0  # the first of several has no neighbour
        return np.exp(np.log(spent.min(axis=0)[:, first:]).mean(axis=1)).tolist()

"""How far a leaner model is from the whole one, for what a scene asks."""

from pathlib import Path
from typing import NamedTuple

from herringbone.analysis.leaner.question import Question, apart, lines_of
from herringbone.analysis.steady.operating_point import Point
from herringbone.analysis.steady.solver import TOLERANCE, SteadySolver
from herringbone.analysis.steady.state import SteadyState
from herringbone.core import HerringboneError
from herringbone.core.declaring.units import R_MIN
from herringbone.core.wording import percent
from herringbone.cosim.structure.system import System
from herringbone.running.operating.at_point import prepared_at
from herringbone.running.operating.questions import USUAL, questions_of
from herringbone.running.prepared import Wishes
from herringbone.scenes import Scene

Run = tuple[str | Path | System, str | Path | Scene | None, Wishes]
"""System, scene, and what is wished over these."""
_FINER, _LEAST = 10.0, 1e-6
"""How much finer than what is asked models are compared, and the least tolerance of that."""


class ModelErrors(NamedTuple):
    """Model errors at an operating point.

    Attributes:
        where: the operating point, for people.
        errors: by question, over the alternating part [1].
        asked: the questions are of the user.
    """

    where: str
    errors: dict[Question, float]
    asked: bool

    @property
    def worst(self) -> Question:
        """The question whose error is largest over what is asked."""
        return max(self.errors, key=lambda q: self.errors[q] / q.tolerance)

    @property
    def is_large(self) -> bool:
        """True if one is larger than what is asked."""
        return self.errors[self.worst] > self.worst.tolerance

    def __str__(self) -> str:
        said = ", ".join(_told(q, error, asked=self.asked) for q, error in self.errors.items())
        return f"model error {self.where}: {said}"


def model_errors(
    whole: Run, leaner: Run, point: Point, state: SteadyState | None = None
) -> ModelErrors:
    """Model errors of what is asked.

    Args:
        whole, leaner: what is compared; the scene of the whole one asks.
        point: operating point.
        state: steady state of the leaner one there, if it is known.

    Raises:
        HerringboneError: one of both has no steady state, or has not what is asked.
    """
    given = prepared_at(point, *whole)
    asked = given.scene.asks
    asks = asked or USUAL
    fine = max(_LEAST, min(TOLERANCE, min(ask.tolerance for ask in asks) / _FINER))
    solver = SteadySolver(given.system, fine)
    questions = questions_of(solver.structure.core, asks)
    theirs = _found(solver.solve(point), "the whole model")
    if state is None or state.tolerance > fine:
        given = prepared_at(point, *leaner)
        own = SteadySolver(given.system, fine, lean=given.scene.model.left_out)
        state = _found(own.solve(point), "the leaner model")
    own_questions = questions_of(state.structure.core, asks)  # of its own housing's data
    errors = {
        q: apart(q, lines_of(state, own), lines_of(theirs, q)).error
        for own, q in zip(own_questions, questions, strict=True)
    }
    where = f"against the whole model, steady at {abs(theirs.speed) * R_MIN:.5g} r/min"
    return ModelErrors(where, errors, bool(asked))


def _told(question: Question, error: float, *, asked: bool) -> str:
    limit = f" (asked: {100.0 * question.tolerance:g} %)" if asked else ""
    return f"{percent(error, 3)} of the {question.name}{limit}"


def _found(state: SteadyState, what: str) -> SteadyState:
    if not state.converged:
        raise HerringboneError(f"{what} has no steady state that was found")
    return state

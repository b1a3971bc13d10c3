"""A rung of a ladder: a model with a solver, its error and its cost."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from herringbone.analysis.leaner.question import Apart, Question
from herringbone.analysis.steady.operating_point import Point
from herringbone.core.lean import WHOLE, Lean

STEADY, FUSED, COUPLED = "steady state", "fused run", "coupled run"
"""Solvers."""


class Worst(NamedTuple):
    """The error that is largest over its tolerance.

    Attributes:
        error: of the question.
        question: which one.
        worst: the output that errs most over its own size.
        worst_error: of that one.
        point: where.
        largest: error of any question at any point, whatever its tolerance.
    """

    error: float
    question: Question
    worst: str
    worst_error: float
    point: Point
    largest: float

    @property
    def ratio(self) -> float:
        """The error over the tolerance."""
        return self.error / self.question.tolerance


def worst(
    questions: Iterable[Question], found: Iterable[tuple[Point, Mapping[str, Apart]]]
) -> Worst:
    """The worst of all questions at all points, at least one."""
    every = [
        Worst(own.error, question, own.worst, own.worst_error, point, own.error)
        for point, by_name in found
        for question in questions
        if (own := by_name[question.name])
    ]
    return worst_of_all(every)


def worst_of_all(every: Sequence[Worst]) -> Worst:
    """The one that is largest over its tolerance, with the largest error of all."""
    largest = max(each.error for each in every)
    return max(every, key=lambda each: each.ratio)._replace(largest=largest)


@dataclass(frozen=True)
class Rung:
    """A model with a solver.

    Attributes:
        name: for people.
        solver: STEADY, FUSED or COUPLED.
        lean: what the model leaves out.
        estimate: of its model error, before it was solved; None: not known.
        measured: the same, certified; None: it was not solved.
        cost: CPU time of an answer at one operating point [s]; None: not measured.
        step: base step of a run [s]; 0 without.
        why: why it is not the choice; "" of the choice.
    """

    name: str
    solver: str
    lean: Lean = WHOLE
    estimate: Worst | None = None
    measured: Worst | None = None
    cost: float | None = None
    step: float = 0.0
    why: str = ""

    @property
    def whole(self) -> bool:
        """True if nothing is left out."""
        return not self.lean

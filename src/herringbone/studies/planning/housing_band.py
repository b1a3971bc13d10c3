"""How far a housing has to be right for what a scene asks, and what a reduced one changes of it."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from herringbone.analysis.leaner.form import Form
from herringbone.analysis.leaner.question import Apart, Lines, Question, apart, lines_of
from herringbone.analysis.steady.solver import SteadySolver
from herringbone.core import ParameterError
from herringbone.running.loading import load_scene, load_system
from herringbone.running.operating.questions import USUAL, questions_of
from herringbone.running.operating.steady import prepared_solver
from herringbone.running.prepared import Wishes
from herringbone.scenes import Scene
from herringbone.studies.planning.points import first_point, points_to_probe

_ROUND = 50.0
"""Bands are multiples of it [Hz]."""


class Asked(NamedTuple):
    """Lines of what a scene asks, at its operating points.

    Attributes:
        system, scene: that ask.
        questions: each with all its outputs, whatever its band.
        lines: by point and question.
    """

    system: str
    scene: Scene
    questions: tuple[Question, ...]
    lines: tuple[tuple[Lines, ...], ...]

    @property
    def largest(self) -> float:
        """Frequency of the largest line of any question [Hz]."""
        return max(lines.highest for each in self.lines for lines in each)

    def beyond(self, band: float) -> tuple[float, Question]:
        """The largest share of a question's alternating part beyond a band [Hz], and which."""
        found = [
            (_beyond(lines, band), question)
            for each in self.lines
            for lines, question in zip(each, self.questions, strict=True)
        ]
        return max(found, key=lambda item: item[0])

    def band(self, tolerance: float) -> float:
        """The smallest band [Hz] beyond which no question has more than a tolerance."""
        highest = max(float(lines.orders[-1]) * lines.frequency for e in self.lines for lines in e)
        for band in np.arange(_ROUND, highest + _ROUND, _ROUND):
            if self.beyond(band)[0] <= tolerance:
                return float(band)
        return float(highest)

    def changed_by(self, housing: Path) -> list[tuple[Question, Apart]]:
        """What another housing changes, at the worst of the points.

        Raises:
            HerringboneError: there is no steady state with it.
        """
        solver = _solver(self.system, self.scene, housing)
        other = _lines(solver, self.scene, _questions(solver, self.scene))
        return [
            (
                question,
                max(
                    (apart(question, ours[k], theirs[k])
                     for ours, theirs in zip(other, self.lines, strict=True)),
                    key=lambda found: found.error,
                ),
            )
            for k, question in enumerate(self.questions)
        ]  # fmt: skip


def asked_of(system: str, scene: str | None, housing: Path | None) -> Asked:
    """What a scene asks of a system with a housing.

    Raises:
        HerringboneError: something about the input is wrong, or there is no steady state.
    """
    own = load_scene(load_system(system)[1], scene)
    solver = _solver(system, own, housing)
    questions = _questions(solver, own)
    return Asked(system, own, questions, _lines(solver, own, questions))


def _questions(solver: SteadySolver, scene: Scene) -> tuple[Question, ...]:
    """All lines of what is asked, whatever its band."""
    return tuple(
        Question(q.name, q.columns, Form.SPECTRUM, q.tolerance, view=q.view)
        for q in questions_of(solver.structure.core, scene.asks or USUAL)
    )


def _solver(system: str, scene: Scene, housing: Path | None) -> SteadySolver:
    at = first_point(scene.operating)
    return prepared_solver(system, scene, at, Wishes(housing=housing))[0]


def _lines(
    solver: SteadySolver, scene: Scene, questions: Sequence[Question]
) -> tuple[tuple[Lines, ...], ...]:
    found, state = [], None
    for point in points_to_probe(scene.operating):
        state = solver.solve(point, state)
        if not state.converged:
            raise ParameterError(
                f"scene {scene.name}: no steady state was found at one of its operating points"
            )
        found.append(tuple(lines_of(state, question) for question in questions))
    return tuple(found)


def _beyond(lines: Lines, band: float) -> float:
    sizes = np.linalg.norm(lines.coefficients[:, 1:], axis=0)
    whole = float(np.linalg.norm(sizes))
    beyond = float(np.linalg.norm(sizes[lines.orders[1:] * lines.frequency > band]))
    return beyond / whole if whole else 0.0

"""A plan for what is asked of a transient: steps of the condensed core, by half of them.

What a transient would lose with a mode is known only when it was marched, and the cost of the core
hardly depends on its modes: the model stays whole.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from herringbone.analysis.leaner.form import Form
from herringbone.analysis.leaner.question import Question
from herringbone.analysis.steady.operating_point import Point
from herringbone.analysis.twin.fused.core import Core, Steps, closeness
from herringbone.analysis.twin.fused.measured import DEGREES, LONGEST, SHORTEST
from herringbone.core import HerringboneError, ParameterError
from herringbone.scenes import Scene
from herringbone.studies.planning.marching import Marched, marched
from herringbone.studies.planning.rung import FUSED, Rung, Worst, worst_of_all

TURN = 0.06
"""Time over which means are taken out of what varies [s]: a turn at 1000 r/min."""
_SAFE = 0.9
"""Of a tolerance: half a step is not the exact solution."""


def transient_rungs(
    core: Core, questions: Sequence[Question], scene: Scene
) -> tuple[list[Rung], list[str]]:
    """The ladder of steps with its choice, and what is to be said.

    Raises:
        ParameterError: it is asked for lines, which a transient has not; no step is short enough.
        CoreStopped: the system has no solution.
    """
    for question in questions:
        if question.form is not Form.SIGNAL:
            raise ParameterError(
                f"ask: {question.name}: a transient has no period; ask for it as signal, or of "
                'motion = "steady"'
            )
    rungs: list[Rung] = []
    columns = tuple(dict.fromkeys(c for q in questions for c in q.columns))
    finer = None
    for steps in _halved(min(q.tolerance for q in questions), scene.t_end):
        try:
            ours = finer or _run(core, scene, steps, columns)
            finer = _run(core, scene, steps._replace(length=0.5 * steps.length), columns)
        except HerringboneError:
            finer = None
            continue
        found = worst_of(questions, columns, ours, finer)
        name = f"whole model, steps of {1e6 * steps.length:.4g} us, degree {steps.degree}"
        rung = Rung(name, FUSED, measured=found, cost=ours.seconds, step=steps.length)
        if found.ratio <= _SAFE:
            return [*rungs, rung], []
        rungs.append(replace(rung, why="its error is above the tolerance"))
    raise ParameterError(
        "plan: no step of the fused system is short enough; ask for a larger tolerance"
    )


def _halved(tolerance: float, t_end: float) -> Iterator[Steps]:
    length = min(LONGEST, t_end)
    while length >= SHORTEST:
        yield Steps(length, DEGREES[0], closeness(tolerance))
        length *= 0.5


def _run(core: Core, scene: Scene, steps: Steps, columns: Sequence[str]) -> Marched:
    return marched(core, scene.t_end, scene.record_step, steps, columns)


def worst_of(
    questions: Sequence[Question], columns: Sequence[str], ours: Marched, theirs: Marched
) -> Worst:
    """The largest difference over its tolerance, against what varies within a turn of the shaft.

    Args:
        questions: what is asked.
        columns: of both marches.
        ours, theirs: at the same times; theirs is the better one.

    Raises:
        ParameterError: nothing of a question varies.
    """
    place = {name: k for k, name in enumerate(columns)}
    window = round(TURN / (theirs.times[1] - theirs.times[0]))
    found = []
    for question in questions:
        own = [place[name] for name in question.columns]
        one, other = (_rows(question, each, own) for each in (ours, theirs))
        off = np.sqrt(np.mean((one - other) ** 2, axis=0))
        size = np.std(_less_slow(other, window), axis=0)
        whole = float(np.linalg.norm(size))
        single = np.where(size > 0.0, off / np.where(size > 0.0, size, 1.0), 0.0)
        k = int(single.argmax())
        if not whole:
            raise ParameterError(f"ask: {question.name}: it does not vary in this run")
        error = float(np.linalg.norm(off)) / whole
        own_worst = question.outputs[k], float(single[k])
        found.append(Worst(error, question, *own_worst, Point(), error))
    return worst_of_all(found)


def _rows(question: Question, march: Marched, columns: Sequence[int]) -> np.ndarray:
    """What is asked for (times, outputs)."""
    values = march.values[:, columns]
    if question.view is None:
        return values
    return question.view.signals(values, march.times[1] - march.times[0])


def _less_slow(values: np.ndarray, window: int) -> np.ndarray:
    """Values (n, columns) less their moving means over some rows, which shrinks at the ends."""
    sums = np.vstack([np.zeros(values.shape[1]), np.cumsum(values, axis=0)])
    rows = np.arange(len(values))
    reach = np.minimum(np.minimum(rows, len(values) - 1 - rows), max(1, window // 2))
    first, last = rows - reach, rows + reach + 1
    return values - (sums[last] - sums[first]) / (last - first)[:, None]

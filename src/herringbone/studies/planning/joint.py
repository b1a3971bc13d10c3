"""Joint choices of model and solver: what each errs in all, and what it costs."""

import time
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from herringbone.analysis.leaner.question import apart, lines_of
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.studies.planning.certified import Certifier
from herringbone.studies.planning.rung import FUSED, Rung, worst

_TOLERANCES = (0.05, 0.01, 1e-3, 1e-4)
"""Of the solver."""
_POINTS, _TIMES = 3, 3


class Joint(NamedTuple):
    """A model with a solver's tolerance.

    Attributes:
        model: name of the rung.
        tolerance: of the solver.
        error: model and solver together, against the whole model solved more finely.
        cost: CPU time of an answer [s].
        floor: error that the model has with any solver; 0 of the whole one.
    """

    model: str
    tolerance: float
    error: float
    cost: float
    floor: float


def joint_choices(certifier: Certifier, rungs: Sequence[Rung]) -> list[Joint]:
    """All rungs that have steady states, with some tolerances, at the first of the test points."""
    found = []
    for rung in rungs:
        if rung.solver == FUSED:
            continue
        measured = None if rung.whole else rung.measured or certifier.error(rung.lean)
        if measured is None and not rung.whole:
            continue
        floor = 0.0 if measured is None else measured.error
        for tolerance in _TOLERANCES:
            if (own := _solved(certifier, rung, tolerance)) is not None:
                found.append(Joint(rung.name, tolerance, *own, floor))
    return found


def _solved(certifier: Certifier, rung: Rung, tolerance: float) -> tuple[float, float] | None:
    """Error and cost; None if there is no steady state."""
    solver, spent, errors = certifier.solver(rung.lean, tolerance), [], []
    few = list(zip(certifier.points, certifier.lines, strict=True))[:_POINTS]
    with one_blas_thread():
        for point, theirs in few:
            for _ in range(_TIMES):
                start = time.thread_time()
                state = solver.solve(point)
                spent.append(time.thread_time() - start)
            if not state.converged:
                return None
            by_name = {
                q.name: apart(q, lines_of(state, q), theirs[q.name]) for q in certifier.questions
            }
            errors.append((point, by_name))
    return worst(certifier.questions, errors).error, float(np.median(spent))

"""Where the time of a step of the fused test rig goes.

Parts of a step are repeated by themselves, with the arrays of a step of scene `loaded`, so that
nobody waits for their results; what a step takes beyond their sum is small loops, and waiting.
"""

from functools import partial

import numpy as np

from herringbone.analysis.twin.fused import repeated
from herringbone.analysis.twin.fused.core import Core, Steps, closeness
from herringbone.analysis.twin.fused.course import Course
from herringbone.benchmarks.step_part import SCENE, STEP, SYSTEM, StepPart, least, timed
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.running.prepared import Wishes, prepared

_STEPS = Steps(STEP, 4, closeness(1e-3))
_BEFORE = 0.03  # time [s] marched before the parts of a step are taken
_AGAIN = 2000


def measure(repeats: int = 5, steps: int = 8000) -> list[StepPart]:
    """Measure a fused step and its parts.

    Args:
        repeats: of each measurement; the least counts.
        steps: of each measurement.
    """
    with one_blas_thread():
        return _measured(repeats, steps)


def _measured(repeats: int, steps: int) -> list[StepPart]:
    core = Core(prepared(SYSTEM, SCENE, Wishes()).system)
    columns = [name for names in core.groups().values() for name in names]
    run = core.solution(_STEPS)
    run.enter(0.0, _BEFORE)
    run.part(0.0, _BEFORE, STEP, np.array([np.inf]))
    arrays, rungs = run.arrays, run.matrices.of(STEP)
    given, chosen, laws = repeated.given(arrays)
    found = {
        f"laws at {_STEPS.degree} nodes": lambda: repeated.laws(_AGAIN, arrays, _BEFORE),
        "products of matrices": lambda: repeated.products(
            _AGAIN, arrays, rungs, given, chosen, laws
        ),
        "arguments of laws inside of the step": lambda: repeated.arguments(_AGAIN, arrays),
        "residuals and their correction": lambda: repeated.corrections(_AGAIN, arrays, rungs),
    }
    parts = [
        StepPart(name, least(partial(timed, part), repeats) / _AGAIN, within=True)
        for name, part in found.items()
    ]
    held = core.solution(_STEPS)
    held.enter(0.0, 1.0)
    samples = held.part(0.0, 1.0, STEP, np.arange(_AGAIN) * STEP)
    outputs = core.outputs(columns, _STEPS, inside=False)
    each = least(lambda: timed(lambda: outputs.values(held, samples)), repeats) / _AGAIN
    parts.append(StepPart(f"{len(columns)} outputs", each, within=True))
    whole = least(lambda: _marched(core, columns, steps), repeats)
    rest = whole - sum(part.seconds for part in parts)
    return [
        StepPart(f"fused, {1e6 * STEP:g} us, degree {_STEPS.degree}", whole, within=False),
        *parts,
        StepPart("rest: small loops, waiting for memory and results", rest, within=True),
    ]


def _marched(core: Core, columns: list[str], steps: int) -> float:
    """CPU time of a step [s], the least of all portions."""
    course, found = Course(core, np.arange(steps + 1) * STEP, _STEPS, columns), np.inf
    while not course.ended:
        row = course.row
        seconds = timed(course.advance)
        found = min(found, seconds / (course.row - row))
    return found

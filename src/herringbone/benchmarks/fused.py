"""Simulated time per CPU time of the loop's thread: the test rig fused, and coupled by FMI.

The loops are run by turns. Errors are those of 20 ms against Dormand-Prince on the plain
equations.
"""

import time
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from herringbone.analysis.accuracy.apart import differences
from herringbone.analysis.twin.fused.core import Core, Steps
from herringbone.analysis.twin.fused.course import Course
from herringbone.analysis.twin.fused.measured import suited, values_at
from herringbone.core.one_thread import one_blas_thread
from herringbone.core.part import closing_all
from herringbone.cosim.algorithms import LI
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.system import System
from herringbone.running.loading import open_parts
from herringbone.running.prepared import Wishes, prepared

TOLERANCE = 1e-3
RECORD_STEP = 1e-4
"""Time between records [s]."""
_SYSTEM = "test_rig"
_WINDOW = 0.02
_EXACT = 1e-9
_SCENES = ("loaded", "separation")
_LONG, _SHORT = 1.0, 0.2
"""Simulated times [s]; what a loop costs is the difference, without what comes before it."""


class Speed(NamedTuple):
    """A loop that was measured.

    Attributes:
        name: what was run.
        error: of the group of channels that errs most.
        worst: largest error of one channel over its own alternating part.
        factor: simulated time over CPU time.
    """

    name: str
    error: float
    worst: float
    factor: float


def measure(repeats: int = 5) -> list[Speed]:
    """Measure all loops.

    Raises:
        HerringboneError: native FMUs cannot be built.
    """
    loops: dict[str, Callable[[float], float]] = {}
    errors: dict[str, tuple[float, float]] = {}
    with one_blas_thread():
        for scene in _SCENES:
            system = prepared(_SYSTEM, scene, Wishes()).system
            core = Core(system)
            steps = suited(core, TOLERANCE, _LONG).steps
            channels = [name for names in core.groups().values() for name in names]
            called = f"{scene}, fused, {1e6 * steps.length:g} us, degree {steps.degree}"
            for what, columns in ((f"{len(channels)} channels", channels), ("all", core.names)):
                name = f"{called}, {what} recorded"
                loops[name] = _fused(core, steps, columns)
                errors[name] = _errors(core, steps)
            algorithm = LI(degree=3)
            name = f"{scene}, native FMUs, {algorithm} at {1e6 * algorithm.start_step:g} us"
            loops[name] = _coupled(system, algorithm)
            errors[name] = (np.nan, np.nan)
        best = dict.fromkeys(loops, np.inf)
        for _ in range(repeats):
            for name, loop in loops.items():
                per = (loop(_LONG) - loop(_SHORT)) / (_LONG - _SHORT)
                best[name] = min(best[name], per)
    return [Speed(name, *errors[name], 1.0 / best[name]) for name in loops]


def _fused(core: Core, steps: Steps, columns: Sequence[str]) -> Callable[[float], float]:
    """CPU time [s] of a fused run of some length [s]."""

    def run(t_end: float) -> float:
        times = np.arange(round(t_end / RECORD_STEP) + 1) * RECORD_STEP
        course = Course(core, times, steps, columns)
        begin = time.thread_time()
        while not course.ended:
            course.advance()
        return time.thread_time() - begin

    return run


def _coupled(system: System, algorithm: LI) -> Callable[[float], float]:
    """CPU time [s] of a coupled run of some length [s]."""

    def run(t_end: float) -> float:
        parts = open_parts(system, "native")
        begin = time.thread_time()
        with closing_all(parts):
            simulate(system, parts, algorithm, make_grid(t_end, algorithm.start_step, RECORD_STEP))
        return time.thread_time() - begin

    return run


def _errors(core: Core, steps: Steps) -> tuple[float, float]:
    """Largest error of a group, and of a channel."""
    groups = core.groups()
    columns = [name for names in groups.values() for name in names]
    times = np.arange(round(_WINDOW / RECORD_STEP) + 1) * RECORD_STEP
    found, exact = values_at(core, times, steps, columns), core.twin.solve(times, columns, _EXACT)
    off = differences(found, exact, columns, groups)
    return max(off.groups.values()), off.worst_difference

"""Where the time of a macro step of the coupled test rig goes, native FMUs.

More passes of the algorithm, and inner steps of half the length, show what passes and inner steps
cost within the loop. The cost of the housing does not depend on values, and is that of the part
alone.
"""

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from herringbone.analysis.anatomy import anatomy
from herringbone.benchmarks.step_part import SCENE, STEP, SYSTEM, StepPart
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.part import closing_all
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.algorithms import LI
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.system import System
from herringbone.running.loading import load_system, open_parts
from herringbone.running.prepared import Wishes, prepared

DEGREE, MICRO_STEP = 3, 16.7e-6
"""Degree of the coupling, and inner step of the gear pair [s], for an error of about 0.1 %."""


def measure(repeats: int = 5, steps: int = 8000) -> list[StepPart]:
    """Measure a coupled step and its parts.

    Args:
        repeats: of each measurement; the least counts.
        steps: of each measurement.

    Raises:
        HerringboneError: native FMUs cannot be built.
    """
    with one_blas_thread():
        return _measured(repeats, steps)


def _measured(repeats: int, steps: int) -> list[StepPart]:
    parts = anatomy(load_system(SYSTEM)[0])
    (gear,), (housing,) = parts.with_role(Role.GEAR_PAIR), parts.with_role(Role.HOUSING)
    inner = str(parts.column(gear, Quantity.MICRO_STEP))
    system, finer = (
        prepared(SYSTEM, SCENE, Wishes(values={inner: h})).system
        for h in (MICRO_STEP, 0.5 * MICRO_STEP)
    )
    alone = replace(
        system, parts=tuple(p for p in system.parts if p.name == housing), connections=()
    )
    algorithm, more = LI(degree=DEGREE), LI(degree=DEGREE, iterations=2)
    runs = ((system, algorithm), (system, more), (finer, algorithm))
    whole, more_often, fine = _simulated(runs, repeats, steps)
    # Without forces its motion dies away, after a while below the least normal numbers, where
    # processors take ten times as long.
    (own,) = _simulated([(alone, algorithm)], repeats, steps // 4)
    one = (more_often.seconds - whole.seconds) / (more_often.passes - whole.passes)
    passes = whole.passes * one
    return [
        StepPart(
            f"native FMUs, {algorithm}, {1e6 * STEP:g} us, gear at {1e6 * MICRO_STEP:g} us",
            whole.seconds,
            within=False,
        ),
        StepPart(
            f"{whole.passes:.2f} passes over all parts, {1e6 * one:.1f} us each", passes, True
        ),
        StepPart("in them: inner steps of the gear pair", fine.seconds - whole.seconds, True),
        StepPart("in them: the housing", whole.passes * own.seconds / own.passes, True),
        StepPart("rest: what is done once, and rows", whole.seconds - passes, True),
    ]


class _Loop(NamedTuple):
    """CPU time [s] and passes of a macro step."""

    seconds: float
    passes: float


def _simulated(runs: Sequence[tuple[System, LI]], repeats: int, steps: int) -> tuple[_Loop, ...]:
    """A macro step of each, without what comes before the first; by turns."""
    counts = (steps // 4, steps)
    least = np.full((len(runs), len(counts)), np.inf)
    passes = np.zeros((len(runs), len(counts)))
    for _ in range(repeats):
        for k, (system, algorithm) in enumerate(runs):
            for n, count in enumerate(counts):
                seconds, passes[k, n] = _of_run(system, algorithm, count)
                least[k, n] = min(least[k, n], seconds)
    found = [(of[:, 1] - of[:, 0]) / (counts[1] - counts[0]) for of in (least, passes)]
    return tuple(_Loop(float(t), float(n)) for t, n in zip(*found, strict=True))


def _of_run(system: System, algorithm: LI, steps: int) -> tuple[float, int]:
    """CPU time [s] and passes of a run of so many macro steps."""
    parts = open_parts(system, "native")
    with closing_all(parts):
        grid = make_grid(steps * STEP, STEP, STEP)
        begin = time.thread_time()
        found = simulate(system, parts, algorithm, grid)
        return time.thread_time() - begin, max(found.passes.values())

"""Marches of the condensed core, and what they cost."""

import time
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from herringbone.analysis.twin.fused.core import Core, Steps
from herringbone.analysis.twin.fused.course import Course
from herringbone.core.process.one_thread import one_blas_thread


class Marched(NamedTuple):
    """Rows of a march.

    Attributes:
        times: (n,) [s].
        values: (n, columns).
        seconds: CPU time of the thread, without the set-up [s].
    """

    times: np.ndarray
    values: np.ndarray
    seconds: float


def marched(
    core: Core, t_end: float, record_step: float, steps: Steps, columns: Sequence[str]
) -> Marched:
    """March from the start values to an end [s].

    Raises:
        CoreStopped: the system has no solution with these steps.
    """
    times = np.arange(round(t_end / record_step) + 1) * record_step
    rows = []
    with one_blas_thread():
        course = Course(core, times, steps, columns)
        begin = time.thread_time()
        while not course.ended:
            rows.append(course.advance()[1])
        return Marched(times, np.concatenate(rows), time.thread_time() - begin)

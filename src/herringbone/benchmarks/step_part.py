"""A part of a macro step of the test rig, and how it is timed."""

import time
from collections.abc import Callable
from typing import NamedTuple

STEP = 1e-4
"""Macro step, and time between records [s]."""
SYSTEM, SCENE = "test_rig", "loaded"


class StepPart(NamedTuple):
    """A part of a macro step.

    Attributes:
        name: what it is.
        seconds: CPU time of the thread.
        within: True if it is part of the step that stands before it.
    """

    name: str
    seconds: float
    within: bool


def timed(run: Callable[[], object]) -> float:
    """CPU time of the thread [s]."""
    begin = time.thread_time()
    run()
    return time.thread_time() - begin


def least(run: Callable[[], float], repeats: int) -> float:
    """The least of repeated measurements."""
    return min(run() for _ in range(repeats))

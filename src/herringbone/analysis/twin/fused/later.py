"""Errors of steps after the time over which they were tried.

A run is measured from end to end where that costs little. Windows of a longer one begin at marks
that it left, so that they see what their own time adds, and nothing that has grown since before.
"""

from collections.abc import Sequence
from itertools import chain, pairwise
from typing import NamedTuple

import numpy as np

from herringbone.analysis.twin.condensed.solution import CoreStopped
from herringbone.analysis.twin.fused.core import Core
from herringbone.analysis.twin.fused.mark import Mark
from herringbone.analysis.twin.fused.measured import WINDOW, Measured, measured

WHOLE = 0.1
"""Runs up to this [s] are measured from end to end: that marches as long as five windows do."""
_APART = 1.0
"""Time of a run for each window [s]: what one costs is a few percent of it."""
_MOST = 8
_SAME = 1e-9


class Later(NamedTuple):
    """What is known of the error after the first window.

    Attributes:
        windows: that were measured; one from 0 on is the whole run.
        bends: places between windows where a law bends: what errors there grow to is not known.
    """

    windows: tuple[Measured, ...] = ()
    bends: int = 0

    @property
    def worst(self) -> Measured | None:
        """The window with the largest error."""
        return max(self.windows, key=lambda window: window.error, default=None)

    @property
    def whole(self) -> bool:
        """True if the run was measured from end to end."""
        return any(window.begin == 0.0 for window in self.windows)


def watched(t_end: float) -> tuple[float, ...]:
    """Times at which a run has to leave marks for `later` [s]: ends and begins of the windows."""
    if t_end <= WHOLE * (1.0 + _SAME):
        return ()
    count = min(_MOST, max(1, int(t_end / _APART * (1.0 + _SAME))))
    ends = (np.arange(1, count + 1) * (t_end / count)).tolist()
    return (WINDOW, *chain.from_iterable((end - WINDOW, end) for end in ends))[:-1]


def later(core: Core, trial: Measured, t_end: float, marks: Sequence[Mark]) -> Later:
    """The error of steps of a run that has ended.

    Args:
        core: of the system.
        trial: of the steps.
        t_end: its end [s].
        marks: that it left at the `watched` times.

    Returns:
        Nothing if the first window was all of the run, or these or half the steps have no solution.
    """
    if t_end <= WINDOW * (1.0 + _SAME):
        return Later()
    try:
        if not marks:
            return Later((measured(core, trial.steps, t_end),))
        found = tuple(measured(core, trial.steps, WINDOW, m, trial) for m in marks[1::2])
    except CoreStopped:
        return Later()
    between = pairwise(mark.bends for mark in marks)
    return Later(found, sum(after - before for before, after in list(between)[::2]))

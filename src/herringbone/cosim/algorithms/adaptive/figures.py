"""What an adaptive run tells of itself: the lengths of its steps, and its error."""

import numpy as np

from herringbone.cosim.layouts.adaptive import Adaptive
from herringbone.cosim.loops.adaptive_step.ladder import TICKS
from herringbone.cosim.loops.adaptive_step.step_error import COUPLING, INNER_STEPS, SIZE
from herringbone.cosim.rows.record import Grid
from herringbone.cosim.rows.recording import ErrorEstimate, StepStatistics

_MOST_OF_IT = 0.9
"""Share of a run."""
_LITTLE = 0.1
"""Share of the tolerance."""


def step_statistics(adaptive: Adaptive, tick: float) -> StepStatistics:
    """Macro steps by their length.

    Args:
        adaptive: of the run.
        tick: in which steps are counted [s].
    """
    taken = np.repeat(adaptive.rungs, adaptive.taken) * tick
    lengths = np.sort(taken) if taken.size else np.zeros(1)
    return StepStatistics(
        int(taken.size),
        int(adaptive.rejected.sum()),
        float(lengths[0]),
        float(np.median(lengths)),
        float(lengths[-1]),
    )


def longest_steps(adaptive: Adaptive, grid: Grid, tolerance: float) -> str:
    """A line if most of the run was in the longest steps that there are, and errs little; or "".

    Args:
        adaptive: of the run.
        grid: in ticks.
        tolerance: that is asked for [1].
    """
    most = min(grid.every or TICKS, TICKS)
    rung = int(np.searchsorted(adaptive.rungs, most, side="right")) - 1
    share = adaptive.rungs[rung] * adaptive.taken[rung] / adaptive.last
    if share < _MOST_OF_IT or not adaptive.far[0] < _LITTLE * tolerance:
        return ""
    what = "rows are apart" if most == grid.every else "steps can be"
    return (
        f"macro steps are as long as {what} ({most * grid.step:.3g} s), and err "
        f"{adaptive.far[0]:.2g}, where {tolerance:g} is asked for"
    )


def error_estimate(adaptive: Adaptive, tolerance: float) -> ErrorEstimate | None:
    """Error of the run so far: of the group of forces that errs most, over their alternation.

    That of the run, if it goes on as it began, see `step_error`; None before the first step.
    """
    covered, errors = adaptive.covered[0], adaptive.errors
    count = adaptive.measured.members
    if not covered > 0.0 or not count.size:
        return None
    sizes = adaptive.moments[SIZE, : count.size]
    parts = np.sqrt(errors / (covered * count)) / sizes
    worst = parts[:, np.hypot(*parts).argmax()]
    return ErrorEstimate(tolerance, float(worst[COUPLING]), float(worst[INNER_STEPS]))

"""Steps of a fused run for a tolerance, by trial: what halving them changes over a short time."""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from herringbone.analysis.accuracy.apart import differences
from herringbone.analysis.twin.fused.core import Core, Steps, closeness
from herringbone.analysis.twin.fused.course import Course
from herringbone.core import HerringboneError, ParameterError
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.loops.adaptive_step.step_error import LEAST

WINDOW = 0.02
"""Time over which steps are tried [s]."""
LONGEST, SHORTEST = 1e-4, 0.4e-6
"""Base steps that are tried, halved from one to the next [s]."""
DEGREES = (4, 5)
_SAFE = 0.95
"""Share of the tolerance that is used: the window is not the run."""
_FEWEST = 16
"""Points of a window, at least."""


class Measured(NamedTuple):
    """Errors of steps, by half of them.

    Attributes:
        steps: that were tried.
        groups: error by group of channels, over the alternating part.
        worst: the output with the largest error over its own alternating part; "" if none varies.
        worst_error: of that one.
        window: time over which they were tried [s].
    """

    steps: Steps
    groups: Mapping[str, float]
    worst: str
    worst_error: float
    window: float

    @property
    def error(self) -> float:
        """Of the group that errs most."""
        return max(self.groups.values(), default=0.0)


def suited(core: Core, tolerance: float, t_end: float) -> Measured:
    """The longest steps whose error stays below a tolerance at the start of a run.

    Args:
        core: of the system.
        tolerance: relative error of each group of channels, over its alternating part.
        t_end: end of the run [s].

    Raises:
        ParameterError: no step is short enough.
        CoreStopped: the system has no solution.
    """
    found = None
    for steps in _candidates(tolerance, min(t_end, WINDOW)):
        try:
            found = measured(core, steps, t_end)
        except HerringboneError:
            if steps.length <= SHORTEST:
                raise
            continue
        if found.error <= _SAFE * tolerance:
            return found
    least = f", {found.error:.2g} at {found.steps.length:.3g} s" if found else ""
    raise ParameterError(
        f"tolerance = {tolerance:g}: no step of the fused system is short enough{least}; use a "
        "larger tolerance"
    )


def _candidates(tolerance: float, window: float) -> Iterator[Steps]:
    length = min(LONGEST, window / _FEWEST)
    while length >= SHORTEST:
        for degree in DEGREES:
            yield Steps(length, degree, closeness(tolerance))
        length *= 0.5


def measured(core: Core, steps: Steps, t_end: float) -> Measured:
    """The error of steps at the start of a run.

    Args:
        core: of the system.
        steps: to be tried.
        t_end: end of the run [s].

    Raises:
        CoreStopped: the system has no solution with these steps.
    """
    window = min(t_end, WINDOW)
    groups = core.groups()
    columns = list(dict.fromkeys(name for names in groups.values() for name in names))
    times = np.linspace(0.0, window, max(_FEWEST, round(window / steps.length)) + 1)
    half = steps._replace(length=0.5 * steps.length)
    ours, theirs = (values_at(core, times, own, columns) for own in (steps, half))
    found = differences(ours, theirs, columns, groups, LEAST)
    return Measured(steps, found.groups, found.worst, found.worst_difference, window)


def values_at(core: Core, times: np.ndarray, steps: Steps, columns: Sequence[str]) -> np.ndarray:
    """Outputs (times, columns) of a march from the start values on.

    Args:
        core: of the system.
        times: equidistant from 0 [s].
        steps: how it is marched.
        columns: outputs.

    Raises:
        CoreStopped: the system has no solution with these steps.
    """
    course = Course(core, times, steps, columns)
    rows = []
    with one_blas_thread():
        while not course.ended:
            rows.append(course.advance()[1])
    return np.concatenate(rows)

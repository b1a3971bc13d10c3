"""Steps of a fused run for a tolerance, by trial: what halving them changes over a short time."""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from herringbone.analysis.accuracy.apart import differences
from herringbone.analysis.twin.fused.core import Core, Steps, closeness
from herringbone.analysis.twin.fused.course import Course
from herringbone.analysis.twin.fused.mark import Mark
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
_FADED = 1e-3
"""Of its alternating part in an earlier window: what is left of a group of channels that comes to
rest, and single precision would be felt."""
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
        sizes: alternating part of the liveliest output of each group, in its unit.
        begin: of the window [s].
    """

    steps: Steps
    groups: Mapping[str, float]
    worst: str
    worst_error: float
    window: float
    sizes: Mapping[str, float]
    begin: float = 0.0

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
    found, window = None, min(t_end, WINDOW)
    for steps in _candidates(tolerance, window):
        try:
            found = measured(core, steps, window)
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


def measured(
    core: Core,
    steps: Steps,
    window: float,
    after: Mark | None = None,
    earlier: Measured | None = None,
) -> Measured:
    """The error of steps at the start of a run, or after a mark of it.

    Args:
        core: of the system.
        steps: to be tried.
        window: time over which they are [s].
        after: begin there; it was left by a run with steps of the same degree.
        earlier: window against which groups that have come to rest since are left out.

    Raises:
        CoreStopped: the system has no solution with these steps.
    """
    groups = core.groups()
    columns = _columns(groups)
    times = np.linspace(0.0, window, max(_FEWEST, round(window / steps.length)) + 1)
    half = steps._replace(length=0.5 * steps.length)
    ours, theirs = (values_at(core, times, own, columns, after) for own in (steps, half))
    spread = dict(zip(columns, np.std(theirs, axis=0).tolist(), strict=True))
    sizes = {name: max(spread[c] for c in own) for name, own in groups.items()}
    before = earlier.sizes if earlier else {}
    groups = {n: own for n, own in groups.items() if sizes[n] >= _FADED * before.get(n, 0.0)}
    kept = [columns.index(name) for name in _columns(groups)]
    found = differences(ours[:, kept], theirs[:, kept], _columns(groups), groups, LEAST)
    begin = after.time if after else 0.0
    return Measured(steps, found.groups, found.worst, found.worst_difference, window, sizes, begin)


def _columns(groups: Mapping[str, Sequence[str]]) -> list[str]:
    return list(dict.fromkeys(name for names in groups.values() for name in names))


def values_at(
    core: Core,
    times: np.ndarray,
    steps: Steps,
    columns: Sequence[str],
    after: Mark | None = None,
) -> np.ndarray:
    """Outputs (times, columns) of a march from the start values on, or from a mark.

    Args:
        core: of the system.
        times: equidistant from 0, or since the mark [s].
        steps: how it is marched.
        columns: outputs.
        after: see `Course`.

    Raises:
        CoreStopped: the system has no solution with these steps.
    """
    course = Course(core, times, steps, columns, after=after)
    rows = []
    with one_blas_thread():
        while not course.ended:
            rows.append(course.advance()[1])
    return np.concatenate(rows)

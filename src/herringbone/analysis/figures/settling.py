"""Whether a run has settled: what its last quarter and the one before it have in common.

A motion that still decays, or a load that still moves it, gives figures that a longer run would not
give. On the test rig from equilibrium the seats' velocities change by 9 % from the third to the
last quarter of 20 ms, and by 0.2 % of 0.5 s.
"""

import numpy as np

from herringbone.analysis.accuracy.apart import groups_of
from herringbone.analysis.figures.operating_point import run_mesh_frequency, steady_part
from herringbone.result.result import TIME, Result

_MUCH = 0.05
_FEWEST_ROWS = 80
_FEWEST_PERIODS = 8.0
_ROUNDING = 1e-9
_ROTATING = {"rad", "m", "deg", "rev"}
"""Units of outputs, in no group of channels, that may go on for ever."""


def unsettled(result: Result) -> list[str]:
    """A line on the group that changes most, if it changes by more than 5 %.

    Compared are alternating part (its rms changes) and mean (its shift over that rms) of each group
    of channels. Empty where too little was recorded to say so, or the speed is not steady, which is
    said elsewhere.

    Args:
        result: of a run, records equidistant.
    """
    time = result.data[TIME].to_numpy()
    if not result.outcome.completed or time.size < _FEWEST_ROWS or not steady_part(result).steady:
        return []
    frequency = run_mesh_frequency(result)
    if frequency is not None and frequency * (time[-1] - time[0]) < _FEWEST_PERIODS:
        return []
    changes = {
        name: change
        for name, columns in groups_of(result).items()
        if (name in result.channels or result.units[columns[0]] not in _ROTATING)
        and (change := _change(result.data[columns].to_numpy(float), time)) is not None
    }
    if not changes:
        return []
    name, change = max(changes.items(), key=lambda item: item[1])
    if change <= _MUCH:
        return []
    return [
        f"not settled: {name.replace('_', ' ')} changes by {100.0 * change:.2g} % of its "
        "alternating part from the third to the last quarter of the run; use a longer --t-end"
    ]


def _change(values: np.ndarray, time: np.ndarray) -> float | None:
    """Larger of both changes, of channels (times, n) together; None if they stand still."""
    since = time - time[0]  # of a long run, the last rows are there
    third = values[(since >= 0.5 * since[-1]) & (since < 0.75 * since[-1])]
    last = values[since >= 0.75 * since[-1]]
    before, after = (float(np.sqrt(part.var(axis=0).sum())) for part in (third, last))
    if max(before, after) <= _ROUNDING * np.abs(values).max(initial=0.0):
        return None
    shift = float(np.linalg.norm(last.mean(axis=0) - third.mean(axis=0)))
    return max(abs(after - before), shift) / max(before, after)

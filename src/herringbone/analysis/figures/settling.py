"""Whether a run has settled: what its last quarter and the one before it have in common.

A motion that still decays, or a load that still moves it, gives figures that a longer run would not
give. On the test rig from equilibrium the seats' velocities change by 9 % from the third to the
last quarter of 20 ms, and by 0.2 % of 0.5 s.
"""

import numpy as np

from herringbone.analysis.accuracy.apart import groups_of
from herringbone.analysis.asked import signal
from herringbone.analysis.figures.hunting import longest_hunt
from herringbone.analysis.figures.operating_point import run_mesh_frequency, steady_part
from herringbone.analysis.figures.spectra import hann_weight
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.declaring.units import R_MIN
from herringbone.core.wording import option, percent
from herringbone.result.result import TIME, Result

NOT_SETTLED = "not settled: "
"""How the lines begin."""
_MUCH = 0.05
_FEWEST_ROWS = 80
_FEWEST_PERIODS = 8.0
_ROUNDING = 1e-9
_WITHOUT_UNIT = {"", "1"}
_GROWN = 4.0
"""Growth in a quarter over the rms of what is beside it, above which an output turns: that of a
vibration of its own, which does not grow, is at most 3 where the quarter has a period or more."""
ROTATING = {"rad", "m", "deg", "rev"}
"""Units of outputs, in no group of channels, that may go on for ever."""


def unsettled(result: Result) -> list[str]:
    """A line on the group that changes most, if it changes by more than 5 %.

    Compared are alternating part (its rms changes) and mean (its shift over that rms) of each group
    of channels. Where the speed is not steady, the line tells between which values it varies. Empty
    where too little was recorded to say so.

    Args:
        result: of a run, records equidistant.
    """
    if moving := moving_speed(result):
        return [
            f"{NOT_SETTLED}{moving}, and levels are those of all these speeds; use a longer "
            f"{option('t_end')}, or look at orders over speed (herringbone plot)"
        ]
    found = changes(result)
    if not found:
        return []
    name, change = max(found.items(), key=lambda item: item[1])
    if change <= _MUCH:
        return []
    verb = "change" if name.startswith("outputs") else "changes"
    said = (
        f"{NOT_SETTLED}{name.replace('_', ' ')} {verb} by {percent(change)} of its alternating "
        "part from the third to the last quarter of the run"
    )
    return [f"{said}; {_advice(result)}"]


def _advice(result: Result) -> str:
    """What shows a settled motion: a longer run, or all teeth where each quarter has others."""
    hunt, time = longest_hunt(result), result.data[TIME].to_numpy()
    if hunt is None or hunt[1] <= 0.25 * (time[-1] - time[0]):
        return f"use a longer {option('t_end')}"
    meshes, seconds = hunt
    return (
        f"its teeth differ, and all have met after {meshes} mesh periods only, {seconds:.3g} s: "
        "until then each quarter has others, and levels are those of the teeth that met; "
        f"'herringbone steady {result.info.system}' has the levels of all"
    )


def moving_speed(result: Result) -> str:
    """How a speed varies that is not steady; "": it is, or too little was recorded to say so."""
    speed = signal(result, Role.GEAR_PAIR, Quantity.SPEED, "pinion")
    if speed is None or not result.outcome.completed or speed.size < _FEWEST_ROWS:
        return ""
    if steady_part(result).steady:
        return ""
    later = speed[speed.size // 2 :] * R_MIN
    return (
        f"the pinion's speed varies from {later.min():.5g} to {later.max():.5g} r/min in the "
        "second half of the run"
    )


def changes(result: Result, *, smooth: bool = False) -> dict[str, float] | None:
    """What groups of channels change by, over their alternating parts; see `unsettled`.

    Args:
        result: of a run, records equidistant.
        smooth: weigh both quarters by Hann windows, so that it does not matter how many periods of
            the motion they hold; else by none.

    Returns:
        By group; groups that stand still are left out. None: too little was recorded to say so, or
        the speed is not steady.
    """
    time = result.data[TIME].to_numpy()
    if not result.outcome.completed or time.size < _FEWEST_ROWS or not steady_part(result).steady:
        return None
    frequency = run_mesh_frequency(result)
    if frequency is not None and frequency * (time[-1] - time[0]) < _FEWEST_PERIODS:
        return None
    return {
        name: change
        for name, columns in settling_groups(result).items()
        if (change := _change(_judged(result, columns, time), time, smooth=smooth)) is not None
    }


def settling_groups(result: Result) -> dict[str, list[str]]:
    """Columns by group, without outputs that may go on for ever."""
    return {
        name: columns
        for name, columns in groups_of(result).items()
        if name in result.channels or result.units[columns[0]] not in ROTATING
    }


def _judged(result: Result, columns: list[str], time: np.ndarray) -> np.ndarray:
    """(times, n) channels; of outputs without unit that turn steadily, what is beside that."""
    values = result.data[columns].to_numpy(float)
    if result.units[columns[0]] not in _WITHOUT_UNIT:
        return values
    quarters, times = _quarters(values, time), _quarters(time, time)
    apart = times[1].mean() - times[0].mean()
    rate = (quarters[1].mean(axis=0) - quarters[0].mean(axis=0)) / apart
    lines = [
        np.polynomial.polynomial.polyfit(t, v, 1) for t, v in zip(times, quarters, strict=True)
    ]
    beside = [
        (v - np.polynomial.polynomial.polyval(t, line).T).std(axis=0)
        for t, v, line in zip(times, quarters, lines, strict=True)
    ]
    turns = np.abs(rate) * apart > _GROWN * np.max(beside, axis=0)
    steady = np.abs(lines[1][1] - lines[0][1]) <= _MUCH * np.abs(rate)
    flat = values - np.outer(time - time[0], np.where(turns & steady, rate, 0.0))
    rounding = _ROUNDING * np.abs(values).max(axis=0, initial=0.0)
    return np.where(turns & steady & (np.ptp(flat, axis=0) <= rounding), 0.0, flat)


def _quarters(values: np.ndarray, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rows of the third and of the last quarter."""
    since = time - time[0]  # of a long run, the last rows are there
    return values[(since >= 0.5 * since[-1]) & (since < 0.75 * since[-1])], values[
        since >= 0.75 * since[-1]
    ]


def _change(values: np.ndarray, time: np.ndarray, *, smooth: bool) -> float | None:
    """Larger of both changes, of channels (times, n) together; None if they stand still."""
    third, last = _quarters(values, time)
    if smooth:
        return _smooth_change(third, last)
    before, after = (float(np.sqrt(part.var(axis=0).sum())) for part in (third, last))
    if max(before, after) <= _ROUNDING * np.abs(values).max(initial=0.0):
        return None
    shift = float(np.linalg.norm(last.mean(axis=0) - third.mean(axis=0)))
    return max(abs(after - before), shift) / max(before, after)


def _smooth_change(third: np.ndarray, last: np.ndarray) -> float | None:
    """As `_change`, of samples weighed by Hann windows."""
    means, sizes = [], []
    for part in (third, last):
        weight = hann_weight(len(part))
        means.append(weight @ part)
        sizes.append(float(np.sqrt((weight @ np.square(part - means[-1])).sum())))
    if max(sizes) <= _ROUNDING * np.abs(third).max(initial=0.0):
        return None
    shift = float(np.linalg.norm(means[1] - means[0]))
    return max(abs(sizes[1] - sizes[0]), shift) / max(sizes)

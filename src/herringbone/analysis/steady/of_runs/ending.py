"""The end of a run, taken apart into harmonics.

The period is that of the mesh; where outputs do not repeat with it, as with run-outs, the time
after which the same teeth meet; of foreign gear pairs, whose teeth nobody knows, the shortest time
after which the records repeat; else all of the last quarter, which then stands for a period.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from herringbone.analysis.asked import of_both_gears, signal
from herringbone.analysis.figures.operating_point import run_mesh_frequency, steady_part
from herringbone.analysis.figures.settling import ROTATING, settling_groups
from herringbone.analysis.figures.spectra import hann_weight, mesh_frequency
from herringbone.analysis.steady.of_runs.repeating import repeating
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.wording import percent
from herringbone.result.result import TIME, Result

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

_FEWEST = 16
"""Rows of the last quarter that make harmonics."""
_LAST = 0.25
"""Share of a run that is its end."""
_ROOM = 1.01
"""Length of the end over that of the periods that it is to hold."""
_REPEATS = 2
"""Periods at least that show that it is one."""
NOTHING_IN_DOUBT: Mapping[str, float] = MappingProxyType({})


class Ending(NamedTuple):
    """The end of a run.

    Attributes:
        coefficients: (columns, harmonics), see `outputs.Harmonics`; of all outputs.
        slopes: (columns,) of angles, per second.
        period: [s].
        meshes: mesh periods of the first gear pair in it; 0: not known, or no whole number.
        turns: of the first pinion in it; NaN: not known.
        speed: mean of the first pinion [rad/s]; NaN: not known.
        rest: what does not repeat, over the alternating part of the worst group; NaN: no period was
            found.
        doubt: by group, what levels and means change by where records count less towards the ends
            of the last quarter, over the alternating part; empty: a period was found.
        longer: duration of a run that could show a longer period [s]; 0: there is none to be shown.
        notes: lines that the user should read.
    """

    coefficients: np.ndarray
    slopes: np.ndarray
    period: float
    meshes: int
    turns: float
    speed: float
    rest: float
    doubt: Mapping[str, float] = NOTHING_IN_DOUBT
    longer: float = 0.0
    notes: tuple[str, ...] = ()


def ending_of(run: Result, tolerance: float) -> Ending:
    """The end of a run whose records are equidistant.

    Args:
        run: the run.
        tolerance: share of the alternating part of each group that need not repeat.
    """
    from scipy.interpolate import CubicSpline  # noqa: PLC0415 (lazy)

    time = run.data[TIME].to_numpy()
    rows = np.flatnonzero(time >= time[-1] - _LAST * (time[-1] - time[0])) if time.size else time
    if rows.size < _FEWEST:
        empty = np.full((len(run.signals), 1), np.nan, dtype=complex)
        line = f"the run ends at {run.outcome.time:g} s: too early for any figure"
        return Ending(
            empty, empty[:, 0].real, math.nan, 0, math.nan, math.nan, math.inf, notes=(line,)
        )
    speed = _speed(run, rows)
    own = time[rows]
    records = run.data[run.signals].to_numpy(float)[rows]
    values, groups = CubicSpline(own, records), _places(run)
    length = float(own[-1] - own[0])
    per_turn = abs(speed) / (2.0 * math.pi)
    longer, unit = 0.0, (0, length)
    known = list(_periods(run, speed)) or _of_records(
        run, records, own, list(groups.values()), tolerance
    )
    for meshes, period in known:
        whole = math.floor(length / period)
        if meshes == 1 and whole:
            unit = whole, whole * period
        if whole < _REPEATS:
            longer = _ROOM * _REPEATS * period / _LAST
            continue
        found, slopes = _harmonics(run, values, own, whole * period)
        kept = found[:, ::whole]
        rest = _rest(found, kept, list(groups.values()))
        if rest <= tolerance:
            return Ending(kept, slopes, period, meshes, period * per_turn, speed, rest)
    meshes, period = unit
    found, slopes = _harmonics(run, values, own, period)
    doubt = {name: _doubt(records[:, columns]) for name, columns in groups.items()}
    line = (
        f"no period was found: harmonics are those of the last {period:.4g} s of the run, and "
        f"change by {percent(max(doubt.values(), default=0.0))} with the part of it that counts"
    )
    turns = period * per_turn
    return Ending(found, slopes, period, meshes, turns, speed, math.nan, doubt, longer, (line,))


def _speed(run: Result, rows: np.ndarray) -> float:
    """Mean speed of the first pinion [rad/s]; NaN if it is not known."""
    found = signal(run, Role.GEAR_PAIR, Quantity.SPEED, "pinion")
    return math.nan if found is None else float(hann_weight(rows.size) @ found[rows])


def _periods(run: Result, speed: float) -> Iterator[tuple[int, float]]:
    """Meshes and duration [s] of what may be a period, the shortest first."""
    if run_mesh_frequency(run) is None or not steady_part(run).steady:
        return
    teeth = of_both_gears(run, run.parts_with(Role.GEAR_PAIR)[0], Quantity.NUMBER_OF_TEETH)
    if teeth is None:
        return
    mesh = 1.0 / mesh_frequency(speed, teeth[0])
    for meshes in (1, math.lcm(*(round(z) for z in teeth))):
        yield meshes, meshes * mesh


def _of_records(
    run: Result,
    records: np.ndarray,
    time: np.ndarray,
    groups: Sequence[Sequence[int]],
    tolerance: float,
) -> list[tuple[int, float]]:
    """The same where no teeth are known; meshes are 0."""
    if not steady_part(run).steady:
        return []
    return [(0, t) for t in repeating(records, time, groups, tolerance)]


def _doubt(records: np.ndarray) -> float:
    """What level and mean of records (times, n) change by under a Hann window, over the level."""
    weight = hann_weight(len(records))
    mean, inside = records.mean(axis=0), weight @ records
    size = math.sqrt(records.var(axis=0).sum())
    weighed = math.sqrt((weight @ np.square(records - inside)).sum())
    if size == 0.0:
        return 0.0
    return max(abs(weighed - size), float(np.linalg.norm(inside - mean))) / size


def _harmonics(
    run: Result, values: "CubicSpline", time: np.ndarray, window: float
) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients of the harmonics of the last part of a run, and slopes of angles.

    Time counts from the start of the window.

    Args:
        run: the run.
        values: over time, of all outputs.
        time: of the records [s].
        window: length of that part [s].
    """
    count = round(window / (time[1] - time[0]))
    begin = float(time[-1]) - window
    samples = values(begin + np.arange(count) / count * window)
    rotating = np.array([run.units[name] in ROTATING for name in run.signals])
    slopes = np.where(rotating, (values(time[-1]) - values(begin)) / window, 0.0)
    samples -= np.outer(np.arange(count) / count * window, slopes)
    return (np.fft.rfft(samples, axis=0) / count).T[:, : count // 2], slopes


def _places(run: Result) -> dict[str, list[int]]:
    """Numbers of the columns of each group."""
    place = {name: k for k, name in enumerate(run.signals)}
    return {name: [place[c] for c in columns] for name, columns in settling_groups(run).items()}


def _rest(found: np.ndarray, kept: np.ndarray, groups: Sequence[Sequence[int]]) -> float:
    """What harmonics that are not kept add to the alternating part of the worst group."""
    worst = 0.0
    for own in groups:
        whole, repeating = (float((np.abs(part[own, 1:]) ** 2).sum()) for part in (found, kept))
        if whole > 0.0:
            worst = max(worst, math.sqrt(max(whole - repeating, 0.0) / whole))
    return worst

"""Comparison of two runs: how far apart they are, and levels and orders side by side.

Differences are those of `apart`, at common times, over the alternating part of the second run.
Levels are root mean squares of the alternating parts over the steady part, from where both runs are
steady and within the time that both have, of the channels of a group together; orders are
amplitudes at multiples of each run's own mesh frequency, Hann-windowed, of the channel in which
they are largest.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from herringbone.analysis.accuracy.apart import differences, groups_of
from herringbone.analysis.accuracy.common_ground import (
    Sides,
    of_other_units,
    over_one_part,
    told_units,
)
from herringbone.analysis.accuracy.compared_tables import (
    changed_parameters,
    changed_resources,
    table_of_columns,
    table_of_groups,
    table_of_orders,
)
from herringbone.analysis.figures.operating_point import run_mesh_frequency, steady_part
from herringbone.analysis.figures.standstill import stands_still
from herringbone.core import ParameterError
from herringbone.core.facts import Facts
from herringbone.core.wording import percent
from herringbone.result.folder.load import load
from herringbone.result.result import TIME, Result

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_FEWEST = 4
_SAME = 1e-9
_ALIKE, _APART = 0.02, 0.3
"""Share by which levels may differ, and difference from which on phases make it: 0.3 rad."""


@dataclass(frozen=True, repr=False)
class Comparison(Facts):
    """Two runs side by side.

    Attributes:
        first, second: the runs; relative differences are over the alternating part of the second.
        begin, end: of the times at which they are compared [s].
        groups: one row per group of channels: "group", "unit", "channels", "difference" [1],
            "worst" channel and "worst_difference" [1], "level_first", "level_second" (unit).
        columns: one row per common column: "column", "unit", "difference" [1], "mean_first",
            "mean_second", "rms_first", "rms_second" (alternating part, unit).
        orders: one row per group and mesh order: "group", "unit", "order", "amplitude_first",
            "amplitude_second"; empty without steady mesh frequency in both.
        parameters: parameters that differ: "parameter", "first", "second"; NaN where a run has not
            that one; "computed": it follows from the others.
        resources: files of components that differ: "resource", "first", "second", what tells them
            apart.
        notes: lines to read: what is compared at all, and what only one of them has.
    """

    first: Sides
    second: Sides
    begin: float
    end: float
    groups: pd.DataFrame
    columns: pd.DataFrame
    orders: pd.DataFrame
    parameters: pd.DataFrame
    resources: pd.DataFrame
    notes: tuple[str, ...]

    def plot(self, highest: float | None = None) -> "Figure":
        """Both runs over each other: the worst channel of each group, over time and frequency.

        Args:
            highest: end of the spectra [Hz].
        """
        from herringbone.plotting.comparison import comparison  # noqa: PLC0415 (matplotlib: lazy)

        return comparison(self) if highest is None else comparison(self, highest)

    def summary(self) -> dict[str, Any]:
        """All tables as lists of rows, for JSON."""
        tables = ("groups", "columns", "orders", "parameters", "resources")
        return {
            "first": self.first.name,
            "second": self.second.name,
            "begin": self.begin,
            "end": self.end,
            **{name: getattr(self, name).to_dict("records") for name in tables},
            "notes": list(self.notes),
        }

    def _facts(self) -> dict[str, str]:
        rows = self.groups.itertuples()
        return {
            "runs": f"{self.first.name} and {self.second.name}",
            "compared": f"{self.begin:g} to {self.end:g} s",
            **{str(row.group): percent(float(row.difference), 3) for row in rows},
            "parameters that differ": str(len(self.parameters) or ""),
            "resources that differ": ", ".join(map(str, self.resources["resource"])),
            "notes": "; ".join(self.notes),
        }


def compare(first: Result | str | Path, second: Result | str | Path, *patterns: str) -> Comparison:
    """Compare two runs.

    Args:
        first, second: results, or folders that `herringbone run` has written.
        patterns: columns (`*`, `?`) that make a group of their own each; the channel groups of the
            second run if none are given, or all common columns by unit if it has none.

    Raises:
        ResourceError: a folder holds no results.
        ParameterError: the runs have no columns or no times in common.
    """
    ours, theirs = _side(first), _side(second)
    if ours.name == theirs.name:
        ours, theirs = ours._replace(name="first"), theirs._replace(name="second")
    apart = of_other_units(ours.result, theirs.result)
    strange = {column for columns in apart.values() for column in columns}
    shared = [c for c in theirs.result.signals if c in set(ours.result.signals) - strange]
    if not shared:
        line = f"{ours.name} and {theirs.name} have no columns in common"
        raise ParameterError("; ".join([line, *told_units(apart)]))
    times, values, notes = _at_common_times(ours, theirs, shared)
    cut = [_within(side, times[0], times[-1]) for side in (ours, theirs)]
    (ours, theirs), shorter = over_one_part(cut)
    notes += told_units(apart) + shorter
    if stands_still(theirs.result):
        values = values[0], np.tile(values[1].mean(axis=0), (len(times), 1))
        notes += (f"nothing turns in {theirs.name}: no difference is over its alternating part",)
    groups = _groups(theirs.result, shared, patterns)
    notes += _only(ours, theirs)
    units = theirs.result.units
    found = differences(*values, shared, groups)
    of_groups = table_of_groups(ours, theirs, groups, found, values, shared)
    orders, why = table_of_orders(ours, theirs, groups)
    return Comparison(
        ours,
        theirs,
        float(times[0]),
        float(times[-1]),
        of_groups,
        table_of_columns(ours, theirs, shared, values, units),
        orders,
        changed_parameters(ours.result, theirs.result),
        changed_resources(ours.result, theirs.result),
        (*notes, *why, *_of_phase(of_groups)),
    )


def _within(side: Sides, begin: float, end: float) -> Sides:
    """The part of a run that is compared: levels and orders of both are over the same time [s]."""
    data = side.result.data
    rows = (data[TIME] >= begin - _SAME * end) & (data[TIME] <= end * (1.0 + _SAME))
    result = replace(side.result, data=data[rows].reset_index(drop=True), before=None)
    return side._replace(result=result, part=steady_part(result))


def _of_phase(groups: pd.DataFrame) -> tuple[str, ...]:
    """A line if groups have the same levels, and differ all the same."""
    alike = (groups["level_first"] / groups["level_second"] - 1.0).abs() < _ALIKE
    names = [str(name) for name in groups["group"][alike & (groups["difference"] > _APART)]]
    if not names:
        return ()
    return (
        f"{', '.join(names)}: levels are alike, and differences are of phase: the teeth of both "
        "runs are at other angles at the same time; compare levels and orders",
    )


def _side(given: Result | str | Path) -> Sides:
    if isinstance(given, Result):
        scene = Path(given.info.scene).stem
        name = f"{given.info.system}-{scene}" if scene else given.info.system
    else:
        name, given = str(given), load(given)
    result = given.uniform()
    return Sides(name, result, steady_part(result))


def _at_common_times(
    ours: Sides, theirs: Sides, shared: Sequence[str]
) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray], tuple[str, ...]]:
    """Times [s] of the second run within the first, both runs' columns there, and a note."""
    from scipy.interpolate import CubicSpline  # noqa: PLC0415 (lazy)

    mine, other = (side.result.data[TIME].to_numpy(float) for side in (ours, theirs))
    for side, time in ((ours, mine), (theirs, other)):
        if time.size < _FEWEST:
            raise ParameterError(f"{side.name} has {time.size} records; it takes {_FEWEST}")
    slack = _SAME * max(1.0, float(other[-1]))
    inside = (other >= mine[0] - slack) & (other <= mine[-1] + slack)
    if inside.sum() < _FEWEST:
        raise ParameterError(
            f"{ours.name} has times from {mine[0]:g} to {mine[-1]:g} s, {theirs.name} from "
            f"{other[0]:g} to {other[-1]:g} s: there is nothing to compare"
        )
    times = other[inside]
    near = np.clip(np.searchsorted(mine, times), 1, mine.size - 1)
    near = np.where(times - mine[near - 1] < mine[near] - times, near - 1, near)
    first = ours.result.data[list(shared)].to_numpy(float)
    second = theirs.result.data[list(shared)].to_numpy(float)[inside]
    if (np.abs(mine[near] - times) <= slack).all():
        return times, (first[near], second), ()
    note = f"{ours.name} is interpolated to the times of {theirs.name} by cubic splines"
    return times, (CubicSpline(mine, first)(np.clip(times, mine[0], mine[-1])), second), (note,)


def _groups(result: Result, shared: Sequence[str], patterns: Sequence[str]) -> dict[str, list[str]]:
    """Columns by group, of one unit each."""
    given = {p: result.columns(p) for p in patterns} if patterns else groups_of(result)
    known = set(shared)
    found: dict[str, list[str]] = {}
    for name, columns in given.items():
        kept = [c for c in columns if c in known]
        units = {result.units[c]: None for c in kept}
        for unit in units:
            label = name if len(units) == 1 else f"{name} [{unit or '1'}]"
            found[label] = [c for c in kept if result.units[c] == unit]
    if not found and not patterns:
        bare = replace(result, channels={}, data=result.data[[TIME, *shared]])
        return groups_of(bare)
    return found


def _only(ours: Sides, theirs: Sides) -> tuple[str, ...]:
    """What one run alone has, and how their settings differ, in lines."""
    lines = []
    for side, other in ((ours, theirs), (theirs, ours)):
        alone = [c for c in side.result.signals if c not in set(other.result.signals)]
        if alone:
            lines.append(f"{len(alone)} columns of {side.name} alone, such as {alone[0]}")
    speeds = [run_mesh_frequency(side.result, part=side.part) for side in (ours, theirs)]
    if None not in speeds and abs(speeds[0] - speeds[1]) > 1e-4 * speeds[1]:  # type: ignore[operator]
        lines.append(
            f"mesh frequencies are {speeds[0]:.4g} and {speeds[1]:.4g} Hz: differences over time "
            "say little, levels and orders do"
        )
    return tuple(lines)

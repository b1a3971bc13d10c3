"""How far two runs of the same system with different steps are apart, without a twin."""

from collections.abc import Collection, Mapping
from typing import NamedTuple

import numpy as np
import pandas as pd

from herringbone.analysis.accuracy.error import relative_error
from herringbone.result.result import TIME, Result

_CONSTANT = 1e-9
"""Alternating part over the size of a channel below which it is rounding."""


class Apart(NamedTuple):
    """Differences of two runs, over the alternating parts of the second.

    Attributes:
        groups: by group of channels; groups that do not vary are left out.
        worst: the output that differs most over its own alternating part; "" if none varies.
        worst_difference: of that one.
    """

    groups: Mapping[str, float]
    worst: str
    worst_difference: float


def apart(first: Result, second: Result, exchanged: Collection[str] = ()) -> Apart:
    """Compare two runs at the times that both have.

    Args:
        first, second: runs of the same system; the second is the better one.
        exchanged: outputs that make groups beside the system's channels, see `groups_of`.
    """
    ours, theirs = _common(first.data, second.data)
    groups = {
        name: relative_error(ours[names].to_numpy(float), theirs[names].to_numpy(float))
        for name, names in groups_of(second, exchanged).items()
        if len(ours) > 1 and any(_varies(theirs[n]) for n in names)
    }
    worst, value = "", 0.0
    for column in second.signals:
        if len(ours) > 1 and _varies(theirs[column]):
            found = relative_error(ours[[column]].to_numpy(float), theirs[[column]].to_numpy(float))
            if found > value:
                worst, value = column, found
    return Apart(groups, worst, value)


def groups_of(result: Result, exchanged: Collection[str] = ()) -> dict[str, list[str]]:
    """Columns of real numbers by group: the system's channels, and other outputs by unit.

    Args:
        result: of a run.
        exchanged: outputs that count even if no channel has them; without channels and these, all.
    """
    groups = {name: result.channel(name) for name in result.channels}
    taken = {column for columns in groups.values() for column in columns}
    every = not groups and not exchanged
    for column in result.signals:
        wanted = column in exchanged or every
        if wanted and column not in taken:
            unit = result.units[column] or "1"
            groups.setdefault(f"outputs in {unit}", []).append(column)
    return {name: columns for name, columns in groups.items() if columns}


def _varies(column: pd.Series) -> bool:
    values = column.to_numpy(float)
    return bool(np.std(values) > _CONSTANT * np.abs(values).max(initial=0.0))


def _common(ours: pd.DataFrame, theirs: pd.DataFrame) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Rows of both at the times that both have."""
    first, second = ours[TIME].to_numpy(), theirs[TIME].to_numpy()
    near = np.clip(np.searchsorted(second, first), 1, max(1, second.size - 1))
    near = np.where(np.abs(second[near - 1] - first) < np.abs(second[near] - first), near - 1, near)
    same = np.abs(second[near] - first) <= 1e-9 * max(1.0, float(first[-1]))
    return ours[same].reset_index(drop=True), theirs.iloc[near[same]].reset_index(drop=True)

"""What of two runs is compared: columns of the same units, over one steady part."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from herringbone.analysis.figures.operating_point import SteadyPart
from herringbone.core.names import first_of
from herringbone.result.result import TIME, Result

_NAMED = 3
"""Columns that a line names, at most."""
_SAME = 1e-9


class Sides(NamedTuple):
    """A run, what it is called in a comparison, and the part of it that levels are taken over."""

    name: str
    result: Result
    part: SteadyPart


def of_other_units(first: Result, second: Result) -> dict[tuple[str, str], list[str]]:
    """Columns that two runs have in different units, by these; none where a run tells no unit."""
    found: dict[tuple[str, str], list[str]] = {}
    for column in second.signals:
        units = first.units.get(column, ""), second.units[column]
        if all(units) and units[0] != units[1]:
            found.setdefault(units, []).append(column)
    return found


def told_units(found: dict[tuple[str, str], list[str]]) -> tuple[str, ...]:
    """A line for each pair of units."""
    return tuple(
        f"{first_of(columns, _NAMED)} {'is' if len(columns) == 1 else 'are'} in {one} and in "
        f"{other}: left out"
        for (one, other), columns in found.items()
    )


def over_one_part(sides: Sequence[Sides]) -> tuple[list[Sides], tuple[str, ...]]:
    """Both runs from where the later one is steady, and a line if the other one is earlier."""
    early, late = sorted(sides, key=lambda side: side.part.begin)
    begin = late.part.begin
    if begin - early.part.begin <= max(side.part.sample_step for side in sides) * (1.0 + _SAME):
        return list(sides), ()
    line = (
        f"levels and orders are from {begin:g} s on, where {late.name} is steady; {early.name} is "
        f"from {early.part.begin:g} s on"
    )
    return [_from(side, begin) if side is early else side for side in sides], (line,)


def _from(side: Sides, begin: float) -> Sides:
    time = side.result.data[TIME].to_numpy()
    first = min(int(np.searchsorted(time, begin * (1.0 - _SAME))), time.size - 1)
    part = replace(side.part, rows=slice(first, time.size), begin=float(time[first]))
    return side._replace(part=part)

"""The points of a chart that are there when its user stops it."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from herringbone.analysis.accuracy.work_precision import Point
from herringbone.core import OutcomeKind

Noted = tuple[Point, Sequence[str]]
"""A point, and notes on it."""


class Kept(NamedTuple):
    """Points, and a line on where the user stopped the chart; "" if it is whole."""

    points: Sequence[Noted]
    stopped: str = ""


def kept_points(runs: Iterator[Noted]) -> Kept:
    """Points up to an interrupt, in a run or between two; nothing is run after it.

    Args:
        runs: makes a run for each.

    Raises:
        KeyboardInterrupt: there is no point yet.
    """
    found: list[Noted] = []
    try:
        for point, notes in runs:
            found.append((point, notes))
            if point.outcome == OutcomeKind.INTERRUPTED:
                return Kept(found, _where(point))
    except KeyboardInterrupt:
        if not found:
            raise
        return Kept(found, _where(found[-1][0]))
    return Kept(found)


def _where(last: Point) -> str:
    run = f"{last.algorithm} at {last.step * 1e6:.4g} us"
    return f"interrupted: the chart ends with {run}; what was to come after it is not there"

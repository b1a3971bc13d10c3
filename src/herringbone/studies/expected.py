"""What a study will cost, from points that were computed."""

import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from herringbone.core import ParameterError
from herringbone.core.activity import lasting
from herringbone.result.folder.typed import as_json
from herringbone.studies.evaluators.levels import PERIOD
from herringbone.studies.working.chain import Done

_MEBIBYTE = 2.0**20
_DIGITS = 20
"""Bytes of a number in a table of text."""


@dataclass(frozen=True)
class Expected:
    """What is ahead.

    Attributes:
        points, chains: of the study.
        missing: points that are not there yet.
        cpu: time that these take [s].
        size: of all files in the end [bytes].
    """

    points: int
    chains: int
    missing: int
    cpu: float
    size: float

    def __str__(self) -> str:
        there = self.points - self.missing
        known = f", of which {there} are there" if there else ""
        return (
            f"{_counted(self.points, 'point')} in {_counted(self.chains, 'chain')}{known}; about "
            f"{lasting(self.cpu)} of CPU time, {self.size / _MEBIBYTE:.2g} MiB"
        )


def _counted(count: int, what: str) -> str:
    return f"{count} {what}" + "s" * (count != 1)


def expected(points: int, chains: int, missing: int, known: Sequence[Done]) -> Expected:
    """What a study costs by what some of its points did.

    Args:
        points, chains: of the study.
        missing: points that are not there yet.
        known: chains or parts of them that were computed, at least one.
    """
    cpu = median(each.cpu / len(each.rows) for each in known)
    size = median(_size(each) / len(each.rows) for each in known)
    return Expected(points, chains, missing, cpu * missing, size * points)


def longest_period(known: Sequence[Done]) -> float:
    """Mesh periods after which the motion repeats, of the worst point; 0 if none tells it."""
    told = (row.figures.get(PERIOD, 0.0) for each in known for row in each.rows)
    return max((meshes for meshes in told if meshes > 0.0), default=0.0)


def check_room(ahead: Expected, folder: Path) -> None:
    """Refuse what does not fit on the disk; raises ParameterError."""
    free = shutil.disk_usage(folder).free
    if ahead.size > free:
        raise ParameterError(
            f"the study takes {ahead.size / _MEBIBYTE:.3g} MiB, but there are "
            f"{free / _MEBIBYTE:.3g} MiB free in {folder}; ask for fewer points, or no --series"
        )


def _size(done: Done) -> float:
    """Bytes of a chain, its rows in the table, and its rows over time."""
    chain = len(str(as_json([row.figures for row in done.rows])))
    table = sum(_DIGITS * (len(row.figures) + 2) + len(row.message) for row in done.rows)
    series = sum(result.data.size * 8.0 for result in done.series.values())
    return chain + table + series

"""What a study will cost, from points that were computed."""

import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from herringbone.core import ParameterError
from herringbone.core.process.activity import lasting
from herringbone.core.wording import option
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
        there: points that were there before.
        per_point: CPU time of one [s].
        size: of all files in the end [bytes].
    """

    points: int
    chains: int
    there: int
    per_point: float
    size: float

    @property
    def cpu(self) -> float:
        """CPU time of all that were not there, those included that were tried to tell it [s]."""
        return self.per_point * (self.points - self.there)

    def told(self, where: str) -> str:
        """A line before it is computed.

        Args:
            where: it is, such as "in this process".
        """
        points = _counted(self.points, "point")
        if self.there == self.points:
            return f"{points}: all there, nothing to compute"
        known = f" ({self.there} of them there)" if self.there else ""
        return (
            f"{points}{known} in {_counted(self.chains, 'chain')}; about {lasting(self.cpu)} of "
            f"CPU time {where}, {self.size / _MEBIBYTE:.2g} MiB of files"
        )


def _counted(count: int, what: str) -> str:
    return f"{count} {what}" + "s" * (count != 1)


def expected(points: int, chains: int, there: int, known: Sequence[Done]) -> Expected:
    """What a study costs by what some of its points did.

    Args:
        points, chains: of the study.
        there: points that were there before.
        known: chains or parts of them that were computed, at least one.
    """
    cpu = median(each.cpu / len(each.rows) for each in known)
    size = median(_size(each) / len(each.rows) for each in known)
    return Expected(points, chains, there, cpu, size * points)


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
            f"{free / _MEBIBYTE:.3g} MiB free in {folder}; ask for fewer points, or no "
            f"{option('series')}"
        )


def _size(done: Done) -> float:
    """Bytes of a chain, its rows in the table, and its rows over time."""
    chain = len(str(as_json([row.figures for row in done.rows])))
    table = sum(_DIGITS * (len(row.figures) + 2) + len(row.message) for row in done.rows)
    series = sum(result.data.size * 8.0 for result in done.series.values())
    return chain + table + series

"""Rows of recorded outputs, at communication points."""

import os
from typing import NamedTuple, Protocol

import numpy as np

from herringbone.core import ParameterError

_ROWS = 1024
_GIB = 2.0**30
_SHARE = 0.25
"""Of the memory: the rows are copied into a table, and again where errors are taken."""


class Grid(NamedTuple):
    """Communication and record points.

    Attributes:
        step: communication step size [s]; of an adaptive run the largest.
        count: macro steps.
        every: macro steps per record.
    """

    step: float
    count: int  # type: ignore[assignment]  # hides tuple.count, which nobody calls
    every: int


class Record(Protocol):
    """Where the loop writes rows."""

    values: np.ndarray

    def times(self, done: int) -> np.ndarray:
        """Times [s] of the rows that are complete after `done` units of the grid."""

    def complete(self, done: int) -> int:
        """Number of these rows."""

    def until_row(self, done: int) -> int:
        """Units of the grid in which no row but at their end is completed."""

    def step(self, times: np.ndarray) -> float:
        """Time between rows, or its mean [s]."""


def _check_room(rows: int, columns: int, grid: Grid) -> None:
    needed = 8.0 * rows * columns
    memory = float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    if needed > _SHARE * memory:
        raise ParameterError(
            f"{rows} records of {columns} outputs, every {grid.every * grid.step:g} s, take "
            f"{needed / _GIB:.3g} GiB, but this machine has {memory / _GIB:.3g} GiB of memory, of "
            f"which they may take {100.0 * _SHARE:g} %; use a longer record_step (--record-step) "
            "or a shorter t_end"
        )


class UniformRecord:
    """A row every so many macro steps.

    Args:
        grid: of the run.
        columns: recorded outputs.

    Raises:
        ParameterError: the rows do not fit into the memory of this machine.
    """

    def __init__(self, grid: Grid, columns: int) -> None:
        self._grid = grid
        rows = grid.count // grid.every + 1
        _check_room(rows, columns, grid)
        self.values = np.full((rows, columns), np.nan)

    def times(self, done: int) -> np.ndarray:
        """Times [s] of the rows after `done` macro steps."""
        return np.arange(self.complete(done)) * self.step(np.empty(0))

    def complete(self, done: int) -> int:
        """Number of rows after `done` macro steps."""
        return done // self._grid.every + 1

    def until_row(self, done: int) -> int:
        """Macro steps up to the next row."""
        return self._grid.every - done % self._grid.every

    def step(self, times: np.ndarray) -> float:
        """Time between rows [s]."""
        del times
        return self._grid.every * self._grid.step


class GrowingRecord:
    """Rows whose number and times the loop decides.

    Args:
        columns: recorded outputs.
    """

    def __init__(self, columns: int) -> None:
        self.values = np.empty((_ROWS, columns))
        self.row_times = np.zeros(_ROWS)
        self.rows = 1

    def times(self, done: int) -> np.ndarray:
        """Times [s] of the rows written."""
        del done
        return self.row_times[: self.rows]

    def complete(self, done: int) -> int:
        """Number of rows written."""
        del done
        return self.rows

    def until_row(self, done: int) -> int:
        """One: any step may complete a row."""
        del done
        return 1

    def step(self, times: np.ndarray) -> float:
        """Mean time between rows [s]; 0 with one row."""
        return float(times[-1]) / (times.size - 1) if times.size > 1 else 0.0

    def make_room(self) -> None:
        """Twice the room, if all is used."""
        if self.rows == self.row_times.size:
            self.values = np.concatenate([self.values, np.empty_like(self.values)])
            self.row_times = np.concatenate([self.row_times, np.zeros_like(self.row_times)])

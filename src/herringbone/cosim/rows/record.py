"""Rows of recorded outputs, at communication points."""

import os
import sys
from typing import NamedTuple, Protocol

import numpy as np

from herringbone.core import ParameterError
from herringbone.core.wording import option

_ROWS = 1024
_WINDOW = 4 << 20
"""Bytes of rows that are not yet taken elsewhere."""
_FEWEST = 16
_GIB = 2.0**30
_SHARE = 0.25
"""Of the memory: the rows are copied into a table, and again where errors are taken."""


class Grid(NamedTuple):
    """Communication and record points.

    Attributes:
        step: communication step size [s]; of an adaptive run the largest.
        count: macro steps.
        every: macro steps per record; of an adaptive run the largest ones, 0: records lie where
            steps end.
    """

    step: float
    count: int  # type: ignore[assignment]  # hides tuple.count, which nobody calls
    every: int


class Record(Protocol):
    """Where the loop writes rows: all of a run, or those that have not been dropped yet.

    Attributes:
        values: rows by columns.
        first: row of the run with which `values` begins.
        expected: rows of the whole run; 0 if nobody knows.
    """

    values: np.ndarray
    first: int
    expected: int

    def times(self, done: int) -> np.ndarray:
        """Times [s] of the rows in `values` that are complete after `done` units of the grid."""

    def complete(self, done: int) -> int:
        """Number of rows of the run that are complete then."""

    def until_row(self, done: int) -> int:
        """Units of the grid in which no row but at their end is completed."""

    def room(self, done: int) -> int:
        """Units of the grid for whose rows there is room."""

    def drop(self, done: int) -> None:
        """Forget the complete rows: they have been taken elsewhere."""

    def saved(self) -> np.ndarray:
        """What a checkpoint holds of a record whose complete rows have been dropped."""

    def put(self, saved: np.ndarray) -> None:
        """Go on from a checkpoint."""

    def step(self, last: float, rows: int) -> float:
        """Time between so many rows, or its mean [s]; the last one is at `last` [s]."""


def window_rows(columns: int) -> int:
    """Rows of a record that is emptied while the run goes on."""
    return max(_FEWEST, _WINDOW // (8 * max(columns, 1)))


def _check_room(rows: int, columns: int, grid: Grid) -> None:
    needed = 8.0 * rows * columns
    memory = float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    if needed > _SHARE * memory:
        raise ParameterError(
            f"{rows} records of {columns} outputs, every {grid.every * grid.step:g} s, take "
            f"{needed / _GIB:.3g} GiB, but this machine has {memory / _GIB:.3g} GiB of memory, of "
            f"which they may take {100.0 * _SHARE:g} %; use a longer "
            f"{option('record_step')} or a shorter {option('t_end')}"
        )


class UniformRecord:
    """A row every so many macro steps.

    Args:
        grid: of the run.
        columns: recorded outputs.
        window: rows at a time; None for all rows of the run.

    Raises:
        ParameterError: the rows do not fit into the memory of this machine.
    """

    def __init__(self, grid: Grid, columns: int, window: int | None = None) -> None:
        self._grid, self.first = grid, 0
        self.expected = rows = grid.count // grid.every + 1
        if window is None:
            _check_room(rows, columns, grid)
        self.values = np.full((rows if window is None else min(rows, window), columns), np.nan)

    def times(self, done: int) -> np.ndarray:
        """Times [s] of the rows after `done` macro steps."""
        return np.arange(self.first, self.complete(done)) * self.step(0.0, 0)

    def complete(self, done: int) -> int:
        """Number of rows after `done` macro steps."""
        return done // self._grid.every + 1

    def until_row(self, done: int) -> int:
        """Macro steps up to the next row."""
        return self._grid.every - done % self._grid.every

    def room(self, done: int) -> int:
        """Macro steps before the row that has no room."""
        return (self.first + len(self.values)) * self._grid.every - 1 - done

    def drop(self, done: int) -> None:
        """Begin with the next row."""
        self.first = self.complete(done)

    def saved(self) -> np.ndarray:
        """The first row."""
        return np.array(self.first)

    def put(self, saved: np.ndarray) -> None:
        """Begin with that row."""
        self.first = int(saved)

    def step(self, last: float, rows: int) -> float:
        """Time between rows [s]."""
        del last, rows
        return self._grid.every * self._grid.step


class GrowingRecord:
    """Rows whose number and times the loop decides.

    Args:
        columns: recorded outputs.
        window: rows for which there is room at first; None if none are dropped.

    Attributes:
        row_times: times of `values` [s].
        rows: in `values`. When rows are dropped, the last one stays: the loop looks at its time.
    """

    def __init__(self, columns: int, window: int | None = None) -> None:
        room = _ROWS if window is None else window
        self.values, self.row_times = np.empty((room, columns)), np.zeros(room)
        self.rows, self.first, self.expected = 1, 0, 0

    def times(self, done: int) -> np.ndarray:
        """Times [s] of the rows written."""
        del done
        return self.row_times[: self.rows]

    def complete(self, done: int) -> int:
        """Number of rows written."""
        del done
        return self.first + self.rows

    def until_row(self, done: int) -> int:
        """One: any step may complete a row."""
        del done
        return 1

    def room(self, done: int) -> int:
        """As much as is wanted: `make_room` makes it."""
        del done
        return sys.maxsize

    def drop(self, done: int) -> None:
        """Begin with the last row."""
        del done
        last = self.rows - 1
        self.values[0], self.row_times[0] = self.values[last], self.row_times[last]
        self.first, self.rows = self.first + last, 1

    def saved(self) -> np.ndarray:
        """The first row's number and time, and its values."""
        return np.concatenate([[self.first, self.row_times[0]], self.values[0]])

    def put(self, saved: np.ndarray) -> None:
        """Begin with that row."""
        self.first, self.rows = int(saved[0]), 1
        self.row_times[0], self.values[0] = saved[1], saved[2:]

    def step(self, last: float, rows: int) -> float:
        """Mean time between rows [s]; 0 with one row."""
        return last / (rows - 1) if rows > 1 else 0.0

    def make_room(self) -> None:
        """Twice the room, if all is used."""
        if self.rows == self.row_times.size:
            self.values = np.concatenate([self.values, np.empty_like(self.values)])
            self.row_times = np.concatenate([self.row_times, np.zeros_like(self.row_times)])

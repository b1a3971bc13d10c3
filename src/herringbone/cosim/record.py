"""Rows of recorded outputs, at communication points."""

from typing import NamedTuple, Protocol

import numpy as np

_ROWS = 1024


class Grid(NamedTuple):
    """Communication and record points.

    Attributes:
        step: communication step size [s]; of an adaptive run the largest.
        count: macro steps.
        every: macro steps per record.
    """

    step: float
    count: int
    every: int


class Record(Protocol):
    """Where the loop writes rows."""

    values: np.ndarray

    def times(self, done: int) -> np.ndarray:
        """Times [s] of the rows that are complete after `done` units of the grid."""

    def step(self, times: np.ndarray) -> float:
        """Time between rows, or its mean [s]."""


class UniformRecord:
    """A row every so many macro steps.

    Args:
        grid: of the run.
        columns: recorded outputs.
    """

    def __init__(self, grid: Grid, columns: int) -> None:
        self._grid = grid
        self.values = np.full((grid.count // grid.every + 1, columns), np.nan)

    def times(self, done: int) -> np.ndarray:
        """Times [s] of the rows after `done` macro steps."""
        return np.arange(done // self._grid.every + 1) * self.step(np.empty(0))

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

    def step(self, times: np.ndarray) -> float:
        """Mean time between rows [s]; 0 with one row."""
        return float(times[-1]) / (times.size - 1) if times.size > 1 else 0.0

    def make_room(self) -> None:
        """Twice the room, if all is used."""
        if self.rows == self.row_times.size:
            self.values = np.concatenate([self.values, np.empty_like(self.values)])
            self.row_times = np.concatenate([self.row_times, np.zeros_like(self.row_times)])

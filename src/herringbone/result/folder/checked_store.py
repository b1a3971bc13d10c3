"""A results folder whose run is resumed: what is there already is compared bit by bit."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from herringbone.core import HerringboneError
from herringbone.core.run_table import TableColumns
from herringbone.result.folder.names import OTHERS, ROWS, State, remove_reports
from herringbone.result.folder.others import OtherFile, read_others
from herringbone.result.folder.room import check_room
from herringbone.result.folder.rows import RowFile
from herringbone.result.folder.run_file import RunFile, write_run_file
from herringbone.result.folder.store import Store
from herringbone.result.folder.writing import refused
from herringbone.result.result import Result

_WHY = (
    "the run does not repeat itself, so that it cannot be resumed; its rows stay, begin anew with "
    "--overwrite"
)
"""In words of the command: scripts resume no runs."""


class ReplayError(HerringboneError):
    """A run that was begun again gives other rows than before."""


class CheckedStore(Store):
    """Rows of a run that goes on; those that are there are not written again.

    Args:
        folder: of the run.
        run: what stands in `run.json`.
        start: all that is known of the result.
        there: rows in the folder.
        done: of these, the ones that the run does not compute again.
    """

    def __init__(
        self,
        folder: Path,
        run: RunFile,
        start: Result,
        there: int,
        done: int,
    ) -> None:
        super().__init__(folder, run, start)
        self._there, self._position = there, done

    def begin(self, columns: TableColumns, rows: int = 0) -> None:
        """Open the files; raises ReplayError if the run has other columns than before."""
        check_room(self.folder, rows - self._there, len(columns.names))
        known = self._described(columns)
        if (known.columns, known.units) != (self.run.columns, self.run.units):
            raise ReplayError(f"{self.folder} holds a run with other columns; nothing was changed")
        try:
            remove_reports(self.folder)
        except OSError as error:
            raise refused(error, self.folder) from error
        self.reopen()
        self.run = replace(known, state=State.RUNNING)
        write_run_file(self.folder, self.run)

    def reopen(self) -> None:
        """Open the files; raises HerringboneError."""
        self._rows = RowFile(self.folder / ROWS, len(self.run.columns), self._there)
        if self.run.others:
            self._others = OtherFile(self.folder / OTHERS, self._there)

    @property
    def rows(self) -> int:
        """Rows that the run has come to."""
        return self._position

    def append(
        self, times: np.ndarray, values: np.ndarray, others: Sequence[Sequence[Any]]
    ) -> None:
        """See `RowSink`; raises ReplayError if rows are others than before."""
        again = max(0, min(len(times), self._there - self._position))
        if again:
            self._compare(np.column_stack([times[:again], values[:again]]), others[:again])
        self._position += again
        if again < len(times):
            try:
                super().append(times[again:], values[again:], others[again:])
            finally:
                self._there = self._position = self._file.rows

    def _compare(self, rows: np.ndarray, others: Sequence[Sequence[Any]]) -> None:
        first, last = self._position, self._position + len(rows)
        before = self._file.read(first, last)
        wrong = np.argwhere(before.view(np.int64) != np.ascontiguousarray(rows).view(np.int64))
        if wrong.size:
            row, column = wrong[0]
            raise ReplayError(
                f"{self.folder}: {self.run.columns[column]} is {rows[row, column]!r} at "
                f"{rows[row, 0]:.6g} s, and was {before[row, column]!r}: {_WHY}"
            )
        if not self.run.others:
            return
        known = read_others(self.folder / OTHERS, self.run.others, first, last)
        for k, (name, column) in enumerate(known.items()):
            now = np.array([row[k] for row in others], dtype=column.dtype)
            if not np.array_equal(now, column, equal_nan=column.dtype.kind == "f"):
                raise ReplayError(
                    f"{self.folder}: {name} is not what it was before {rows[-1, 0]:.6g} s: {_WHY}"
                )

    def cut(self, rows: int) -> None:
        """See `RowSink`; raises HerringboneError."""
        super().cut(rows)
        self._there = self._position = min(rows, self._position)

    def write(self, result: Result, state: State) -> None:
        """See `Store`; rows that an interrupted replay has not come to are cut."""
        if self._position < self._there:
            self.cut(self._position)
        super().write(result, state)

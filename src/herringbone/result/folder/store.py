"""A results folder that is being written."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from herringbone.core import OutcomeKind
from herringbone.core.run_table import KeptRows, TableColumns
from herringbone.result.folder.names import OTHERS, ROWS, State
from herringbone.result.folder.others import OtherFile
from herringbone.result.folder.result_file import stored_result
from herringbone.result.folder.room import check_room
from herringbone.result.folder.rows import RowFile
from herringbone.result.folder.run_file import RunFile, write_run_file
from herringbone.result.folder.state_file import remove_states, write_state
from herringbone.result.folder.stored_table import StoredTable
from herringbone.result.result import TIME, Result


class Store:
    """Rows go into a folder.

    Args:
        folder: where they go.
        run: what is known of the run; columns are filled in.
        start: all that is known of its result before there are rows.
        prepare: makes the folder ready as soon as there are columns; it is ready if not given.

    Attributes:
        run: what stands in `run.json`.
    """

    def __init__(
        self,
        folder: Path,
        run: RunFile,
        start: Result,
        prepare: Callable[[], None] = lambda: None,
    ) -> None:
        self.folder, self._prepare = folder, prepare
        self.run = replace(run, state=State.RUNNING, result=stored_result(start))
        self._rows: RowFile | None = None
        self._others: OtherFile | None = None

    def begin(self, columns: TableColumns, rows: int = 0) -> None:
        """See `RowSink`; raises HerringboneError."""
        check_room(self.folder, rows, len(columns.names))
        self._prepare()
        self.run = self._described(columns)
        self._rows = RowFile(self.folder / ROWS, len(self.run.columns))
        if self.run.others:
            self._others = OtherFile(self.folder / OTHERS)
        write_run_file(self.folder, self.run)

    def _described(self, columns: TableColumns) -> RunFile:
        """What is known of the run, with its columns."""
        names = (TIME, *columns.names)
        units = dict(zip(names, ("s", *columns.units), strict=True)) | dict(columns.other_units)
        return replace(self.run, columns=names, units=units, others=dict(columns.others))

    @property
    def rows(self) -> int:
        """Rows that are there."""
        return self._rows.rows if self._rows else 0

    @property
    def _file(self) -> RowFile:
        assert self._rows is not None, "begin comes first"
        return self._rows

    def append(
        self, times: np.ndarray, values: np.ndarray, others: Sequence[Sequence[Any]]
    ) -> None:
        """See `RowSink`; raises HerringboneError."""
        if self._others:
            self._others.append(others)
        self._file.append(np.column_stack([times, values]))

    def cut(self, rows: int) -> None:
        """See `RowSink`; raises HerringboneError."""
        self._file.cut(rows)
        if self._others:
            self._others.cut(self._file.rows)

    @property
    def table(self) -> StoredTable:
        """The rows that are there."""
        return StoredTable(self.folder, self.run.columns, self.run.others, self.rows)

    def checkpoint(self, state: Mapping[str, np.ndarray]) -> None:
        """See `RowSink`; the rows so far are on the disk before. Raises HerringboneError."""
        self._file.sync()
        write_state(self.folder, state)

    def read(self) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """See `RowSink`; raises HerringboneError."""
        for piece in self.table.reals():
            yield piece[:, 0], piece[:, 1:]

    def kept(self) -> KeptRows:
        """See `RowSink`; raises HerringboneError."""
        table = self.table
        data = table.last(table.kept)
        real = data[list(table.columns)].to_numpy()
        others = {name: data[name].to_numpy() for name in table.others}
        return KeptRows(real[:, 0].copy(), np.ascontiguousarray(real[:, 1:]), others)

    def write(self, result: Result, state: State) -> None:
        """Write what is known of the result whose rows are all there; raises HerringboneError."""
        self._file.sync()
        self.run = replace(self.run, state=state, result=stored_result(result))
        write_run_file(self.folder, self.run)
        if result.outcome.kind is not OutcomeKind.INTERRUPTED:
            remove_states(self.folder)

    def close(self) -> None:
        """Close the files."""
        if self._rows:
            self._rows.close()
        if self._others:
            self._others.close()

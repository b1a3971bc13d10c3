"""The rows of a run on their way out while it goes on."""

import time
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from herringbone.core.part import PartVariable
from herringbone.core.run_table import RowSink, TableColumns
from herringbone.cosim.divergence import first_nan
from herringbone.cosim.loops.common import BOUND
from herringbone.cosim.other_signals import OtherSignals
from herringbone.cosim.rows.record import Record, window_rows
from herringbone.cosim.units import in_own_units, own_unit

SELDOM = 1.0
"""Wall time [s] after which rows are handed on, however few they are."""


class Streaming(NamedTuple):
    """Where the rows of a run go while it goes on.

    Attributes:
        sink: takes them.
        every: so many records make a row of the sink.
        keeps_all: the record keeps all rows as well.
        checkpoint: from which the run goes on; None: from its start.
    """

    sink: RowSink
    every: int = 1
    keeps_all: bool = False
    checkpoint: Mapping[str, np.ndarray] | None = None

    def window(self, columns: int) -> int | None:
        """Rows that the record has room for; None for all."""
        return None if self.keeps_all else window_rows(columns)


class Stream:
    """Hands rows on when they are complete.

    Args:
        streaming: where they go.
        record: where the loop writes them.
        others: rows of other types.
        names: columns, `instance.variable`.
        recorded: their variables.

    Attributes:
        rows: of the run that were handed on.
        last: time of the last one [s].
        nan: when columns were no number for the first time [s], by their number; those of other
            types come after the others.
    """

    def __init__(
        self,
        streaming: Streaming,
        record: Record,
        others: OtherSignals,
        names: Sequence[str],
        recorded: Sequence[PartVariable],
    ) -> None:
        self._to, self._record, self._others, self._recorded = streaming, record, others, recorded
        self.rows, self.last, self._flushed = 0, 0.0, time.perf_counter()
        self.nan: dict[int, float] = {}
        types = {name: kind.name for name, kind in others.types.items()}
        units = tuple(own_unit(v) for v in recorded)
        columns = TableColumns(tuple(names), units, types, others.units)
        self.sink.begin(columns, -(-record.expected // streaming.every))

    @property
    def sink(self) -> RowSink:
        """Where the rows go."""
        return self._to.sink

    def flush_in_time(self, done: int) -> None:
        """Hand rows on, if there are many, or it was long ago; see `flush`."""
        waiting = self._record.complete(done) - self.rows
        full = 2 * waiting >= len(self._record.values)
        if full or time.perf_counter() - self._flushed > SELDOM:
            self.flush(done)

    def flush(self, done: int) -> None:
        """Hand on what is complete after `done` units of the grid; raises HerringboneError."""
        self._flushed = time.perf_counter()
        record, complete = self._record, self._record.complete(done)
        if self._others.recorded:
            complete = min(complete, self._others.rows)
        first, last = self.rows - record.first, complete - record.first
        if last > first:
            times = record.times(done)[:last]
            rows = slice(first + -self.rows % self._to.every, last, self._to.every)
            others = self._others.between(self.rows, complete)[rows.start - first :: rows.step]
            if times[rows].size:
                self._append(times[rows], record.values[rows], others)
        self.rows = complete
        if not self._to.keeps_all and complete == record.complete(done):
            record.drop(done)
            self._others.drop(complete)

    def _append(self, times: np.ndarray, values: np.ndarray, others: Sequence) -> None:
        self.sink.append(times, in_own_units(self._recorded, values), others)
        self.last = float(times[-1])
        self.nan = first_nan(times, values, self._others.numbers(others)) | self.nan

    def append(self, time: float, values: np.ndarray) -> None:
        """Hand on a row (columns,) between the records, of which others has a row already."""
        others = self._others.between(self.rows, self.rows + 1)
        self._append(np.array([time]), values[None], others)
        self.rows += 1

    def cut_diverged(self, taken: np.ndarray) -> None:
        """Take back the rows from the first value on that is beyond all bounds.

        Args:
            taken: numbers of the columns that count: those that parts take.
        """
        rows = 0
        for _, values in self.sink.read():
            good = int((np.abs(values[:, taken]) < BOUND).all(axis=1).cumprod().sum())
            rows += good
            if good < len(values):
                break
        self.sink.cut(rows)
        self.rows = rows

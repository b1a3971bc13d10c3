"""The rows of one run: where the loop writes them, and what is left of them in the end."""

import numpy as np

from herringbone.core import Outcome, OutcomeKind
from herringbone.core.part import column
from herringbone.core.run_table import KeptRows
from herringbone.cosim.algorithms.prepared import PreparedRun
from herringbone.cosim.divergence import first_nan, growth
from herringbone.cosim.layouts.layout import record_names
from herringbone.cosim.loops.common import BOUND
from herringbone.cosim.other_signals import OtherSignals
from herringbone.cosim.rows.record import Grid
from herringbone.cosim.rows.stream import Stream, Streaming
from herringbone.cosim.structure.network import Network
from herringbone.cosim.units import in_own_units, own_unit


class RunRows:
    """Rows of a run.

    Args:
        network: parts and connections.
        prepared: the network laid out for the algorithm.
        grid: in the units in which the loop counts.
        others: signals of other types than real.
        streaming: where rows go while the run goes on; None: they stay in memory.

    Attributes:
        names: columns, `instance.variable`.
        recorded: their variables.
        record: where the loop writes.
    """

    def __init__(
        self,
        network: Network,
        prepared: PreparedRun,
        grid: Grid,
        others: OtherSignals,
        streaming: Streaming | None,
    ) -> None:
        self._parts, self._others = network.parts, others
        named = list(zip(network.parts, record_names(network), strict=True))
        self.names = tuple(column(part, n) for part, names in named for n in names)
        self.recorded = [part.variables[n] for part, names in named for n in names]
        columns = len(self.names)
        self.record = prepared.record(grid, columns, streaming and streaming.window(columns))
        self._taken = np.unique(prepared.layout.output_record)
        self._keeps_all = streaming is None or streaming.keeps_all
        self.stream = streaming and Stream(
            streaming, self.record, others, self.names, self.recorded
        )

    @property
    def leave(self) -> bool:
        """True if rows leave the memory while the run goes on."""
        return not self._keeps_all

    @property
    def units(self) -> tuple[str, ...]:
        """Unit of each column, "" if not declared."""
        return tuple(own_unit(v) for v in self.recorded)

    def growth(self, done: int) -> float | None:
        """How much the rows have grown; None of too few, see `divergence.growth`.

        Raises HerringboneError if rows cannot be kept or read.
        """
        stream = self.stream
        if stream is None or self._keeps_all:
            rows = self.record.values[: self.record.complete(done)]
            return growth(lambda: [rows[:, self._taken]])
        stream.flush(done)  # all rows of the run, those before it was resumed too
        return growth(lambda: (values[:, self._taken] for _, values in stream.sink.read()))

    def first_nan(self, done: int) -> tuple[str, float] | None:
        """The first column that is no number in some row, and from when on [s]; None: none is."""
        if self.stream and not self._keeps_all:
            self.stream.flush(done)
            found = self.stream.nan
        else:
            times = self.record.times(done)
            count = min(times.size, self._others.rows) if self._others.recorded else times.size
            others = self._others.numbers(self._others.between(0, count))
            found = first_nan(times, self.record.values[: times.size], others)
        if not found:
            return None
        first = min(found, key=found.__getitem__)
        return (*self.names, *self._others.names)[first], found[first]

    def flush_in_time(self, done: int) -> None:
        """Let complete rows go, now and then; raises HerringboneError."""
        if self.stream:
            self.stream.flush_in_time(done)

    def finish(self, done: int, outcome: Outcome) -> tuple[KeptRows, float]:
        """The rows that are kept, and the time between records [s].

        The state in which an only part ended is a row more. Rows from the first value on that is
        beyond all bounds are taken back, if the run failed.
        """
        between, failed = self._ended_between(done, outcome), self._failed(outcome)
        if between:
            self._others.sample(self.record.complete(done) + 1)
        if self.stream:
            self.stream.flush(done)
            if between:
                self.stream.append(outcome.time, self._last_row())
            elif failed:
                self.stream.cut_diverged(self._taken)
        if self.stream and not self._keeps_all:
            return self.stream.sink.kept(), self.record.step(self.stream.last, self.stream.rows)
        times = self.record.times(done)
        values = self.record.values[: times.size]
        if between:
            times, values = np.append(times, outcome.time), np.vstack([values, self._last_row()])
        elif failed:
            rows = int((np.abs(values[:, self._taken]) < BOUND).all(axis=1).cumprod().sum())
            times, values = times[:rows], values[:rows]
        if self._others.recorded:
            times, values = times[: self._others.rows], values[: self._others.rows]
        others = self._others.columns(times.size)
        last = float(times[-1]) if times.size else 0.0
        kept = KeptRows(times, in_own_units(self.recorded, values), others)
        return kept, self.record.step(last, times.size)

    def _alone(self, outcome: Outcome) -> bool:
        """True if the only part ended the run."""
        return outcome.kind is OutcomeKind.ENDED and len(self._parts) == 1

    def _failed(self, outcome: Outcome) -> bool:
        """True if the run ended where its values may be beyond all bounds."""
        fine = outcome.reached_end or outcome.kind is OutcomeKind.INTERRUPTED
        return not (fine or self._alone(outcome))

    def _ended_between(self, done: int, outcome: Outcome) -> bool:
        """True if the only part ended between communication points."""
        if not self._alone(outcome):
            return False
        times = self.record.times(done)
        last = float(times[-1]) if times.size else self.stream.last if self.stream else 0.0
        return outcome.time > last

    def _last_row(self) -> np.ndarray:
        """The state in which the only part ended."""
        return np.array(self._parts[0].get([v.name for v in self.recorded]), dtype=float)

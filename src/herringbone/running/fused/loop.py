"""The loop of a fused run: portions of steps, how it ends, and the record."""

import time
from collections.abc import Sequence

import numpy as np

from herringbone.analysis.twin.condensed.solution import CoreStopped
from herringbone.analysis.twin.fused.core import Core, Steps
from herringbone.analysis.twin.fused.course import Course
from herringbone.analysis.twin.fused.mark import Mark
from herringbone.core import Outcome, OutcomeKind
from herringbone.core.run_table import KeptRows, TableColumns
from herringbone.cosim.checkpoint import checkpoints
from herringbone.cosim.interrupt import InterruptFlag
from herringbone.cosim.rows import stream
from herringbone.cosim.rows.record import Grid, UniformRecord
from herringbone.cosim.rows.recording import CoreStatistics, Recording
from herringbone.cosim.rows.stream import Streaming
from herringbone.running.reporting.progress import Progress


class FusedRun:
    """One run.

    Args:
        core: of the system.
        steps: how it is marched.
        columns: recorded outputs.
        grid: records.
        streaming: where rows go while it goes on; None: they stay in memory.
        watched: times at which marks are left, see `Course`.
    """

    def __init__(
        self,
        core: Core,
        steps: Steps,
        columns: Sequence[str],
        grid: Grid,
        streaming: Streaming | None,
        watched: Sequence[float] = (),
    ) -> None:
        self._steps, self._columns, self._grid = steps, columns, grid
        self._times = np.arange(grid.count + 1) * grid.step
        self._course = Course(core, self._times, steps, columns, watched=watched)
        self._streaming = streaming
        self._units = tuple(core.unit(name) for name in columns)
        self._waiting: list[tuple[np.ndarray, np.ndarray]] = []
        if streaming is None:
            self._values = UniformRecord(grid, len(columns)).values
        else:
            table = TableColumns(tuple(columns), self._units, {}, {})
            streaming.sink.begin(table, grid.count + 1)
        self._done, self._wall, self._cpu = 0, 0.0, 0.0

    @property
    def marks(self) -> Sequence[Mark]:
        """That were left so far."""
        return self._course.marks

    def go(self, progress: Progress | None) -> Recording:
        """Portion after portion."""
        course, stopped = self._course, None
        if self._streaming and self._streaming.checkpoint is not None:
            saved = self._streaming.checkpoint
            course.put(saved)
            self._done, self._wall = int(saved["rows"]), float(saved["wall"])
        begin = taken = flushed = time.perf_counter()
        worked = time.thread_time()
        before = self._wall
        with InterruptFlag() as flag:
            while not course.ended and not flag.raised and stopped is None:
                try:
                    self._take(*course.advance())
                except CoreStopped as error:
                    stopped = error
                now = time.perf_counter()
                self._wall = before + now - begin
                if now - flushed > stream.SELDOM:
                    self._flush()
                    flushed = now
                if now - taken > checkpoints.SECONDS and stopped is None:
                    self._checkpoint()
                    taken = now
                if progress:
                    progress(float(self._times[max(course.row - 1, 0)]), float(self._times[-1]))
        self._cpu = time.thread_time() - worked
        self._flush()
        if not course.ended and stopped is None:
            self._checkpoint()
        return self._recording(self._outcome(stopped))

    def _take(self, times: np.ndarray, values: np.ndarray) -> None:
        """Keep rows."""
        if self._streaming is None:
            self._values[self._done : self._done + times.size] = values
            self._done += times.size
        elif times.size:
            self._waiting.append((times, values))

    def _flush(self) -> None:
        """Hand rows on; raises HerringboneError."""
        if self._streaming is None or not self._waiting:
            return
        times = np.concatenate([t for t, _ in self._waiting])
        values = np.concatenate([v for _, v in self._waiting])
        self._waiting = []
        self._streaming.sink.append(times, values, [() for _ in times])
        self._done += times.size

    def _checkpoint(self) -> None:
        """Keep the state after the rows so far; raises HerringboneError."""
        if self._streaming is None:
            return
        self._flush()
        more = {
            "rows": np.array(self._done),
            "wall": np.array(self._wall),
            "last": np.array(self._times[max(self._done - 1, 0)]),
            "done": np.array(max(self._done - 1, 0)),
        }
        self._streaming.sink.checkpoint({**self._course.saved(), **more})

    def _outcome(self, stopped: CoreStopped | None) -> Outcome:
        reached = float(self._times[max(self._done - 1, 0)])
        if stopped is not None:
            message = f"{stopped}; use a smaller tolerance or step, or run without fuse"
            return Outcome(OutcomeKind.DIVERGED, stopped.time, message=message)
        if not self._course.ended:
            return Outcome.interrupted(reached)
        return Outcome(OutcomeKind.COMPLETED, reached)

    def _recording(self, outcome: Outcome) -> Recording:
        if self._streaming is None:
            kept = KeptRows(self._times[: self._done], self._values[: self._done], {})
        else:
            kept = self._streaming.sink.kept()
        counts, steps = self._course.counts, self._steps
        length = max((piece.step for piece in self._course.pieces), default=steps.length)
        return Recording(
            kept.time,
            kept.values,
            tuple(self._columns),
            self._units,
            outcome,
            length,
            self._grid.step,
            counts["steps"],
            {},
            counts["halvings"],
            self._wall,
            self._cpu,
            (),
            core=CoreStatistics(steps.degree, length, **counts),
        )

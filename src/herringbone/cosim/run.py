"""One run: the compiled loop in chunks, and the record."""

import time
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from herringbone.core import FmuError, Outcome, OutcomeKind
from herringbone.cosim.algebraic_loop import AlgebraicLoop
from herringbone.cosim.algorithms.prepared import PreparedRun
from herringbone.cosim.checkpoint.checkpoints import Checkpoints
from herringbone.cosim.ending import REFUSED, Ending
from herringbone.cosim.energy.watch import EnergyWatch
from herringbone.cosim.interrupt import InterruptFlag
from herringbone.cosim.layouts.layout import HISTORY, Chunk, connected_outputs
from herringbone.cosim.loops.common import DONE, get_all
from herringbone.cosim.other_signals import OtherSignals
from herringbone.cosim.rows.record import Grid
from herringbone.cosim.rows.recording import Recording
from herringbone.cosim.rows.run_rows import RunRows
from herringbone.cosim.rows.stream import Streaming
from herringbone.cosim.structure.network import Network
from herringbone.cosim.wrapped_angles import wrapped_angles

CHUNK_SECONDS = 0.05
"""Wall time between looks at the interrupt flag, as long as the cost of a step stays the same."""
Progress = Callable[[float, float], None]
"""Called with the simulated time reached and its end [s]."""


class Run:
    """State of one run, outside the compiled loop.

    Args:
        network: initialised parts, and connections.
        prepared: the network laid out for the algorithm.
        grid: communication and record points.
        watch: of the energy.
        notes: on how signals travel.
        others: signals of other types than real.
        streaming: where rows go while it goes on; None: they stay in memory.

    Attributes:
        refusal: what a part said that refused a value of another type than real.
    """

    def __init__(
        self,
        network: Network,
        prepared: PreparedRun,
        grid: Grid,
        watch: EnergyWatch,
        notes: Sequence[str],
        others: OtherSignals,
        streaming: Streaming | None = None,
    ) -> None:
        self.network, self.prepared, self.watch, self.notes = network, prepared, watch, notes
        self.others = others
        self.refusal = ""
        self.grid = grid = prepared.grid(grid)
        self.rows = RunRows(network, prepared, grid, others, streaming)
        self.record = self.rows.record
        self.checkpoint = streaming.checkpoint if streaming else None
        self.history = np.zeros((HISTORY, prepared.layout.output_reference.size))
        self.loop_notes: tuple[str, ...] = ()
        self.start_offsets: Mapping[tuple[int, str], float] = {}

    def go_around(
        self, loop: AlgebraicLoop, algorithm: str, progress: Progress | None
    ) -> Recording:
        """Run with an algebraic loop; an outcome before the first step if it diverges anyway."""
        growth, what = self.prepared.close_loop(loop), loop.describe()
        if growth < 1.0:
            self.loop_notes = (what,)
            return self.go(progress)
        self._first_row()
        instead = "" if loop.gain >= 1.0 else "use li, fixed_point or jacobi:order=0; or "
        message = (
            f"{what}: with {algorithm} the forces grow {growth:.3g} times per macro step, and no "
            f"step helps; {instead}{loop.remedy()}"
        )
        outcome = Outcome(OutcomeKind.COUPLING_FAILED, 0.0, loop.culprit, message)
        return self._recording(0, outcome, 0.0, 0.0)

    def go(self, progress: Progress | None) -> Recording:
        """Run chunk after chunk."""
        self._first_row()
        self._correct_start()
        self.history[1:] = self.history[0]
        done, status, culprit, chunk, before = 0, DONE, -1, 1, 0.0
        self._advance(0, 0)  # compiles the loop, or loads it from the cache
        checkpoints = Checkpoints(self)
        if self.checkpoint is not None:
            done, before = checkpoints.take_up(self.checkpoint)
        status = self._exchange_others(done)  # outputs may change as initialisation ends
        begin, worked = time.perf_counter() - before, time.thread_time()
        with InterruptFlag() as flag:
            while done < self.grid.count and status == DONE and not flag.raised:
                earlier, started = done, time.perf_counter()
                most = min(chunk, self.grid.count - done, self.record.room(done))
                count = self._until_others(done, most)
                status, done, culprit = self._advance(done, count)
                if status == DONE and done > earlier:
                    status = self._exchange_others(done)
                self.rows.flush_in_time(done)
                if status == DONE:
                    checkpoints.take_in_time(done, time.perf_counter() - begin)
                rate = max(done - earlier, 1) / max(time.perf_counter() - started, 1e-9)
                chunk = max(1, min(int(rate * CHUNK_SECONDS), 4 * chunk))
                if progress:
                    progress(done * self.grid.step, self.grid.count * self.grid.step)
        wall, cpu = time.perf_counter() - begin, time.thread_time() - worked
        if status == DONE and done < self.grid.count:
            checkpoints.take(done, wall)
        outcome = Ending(self, done).outcome(status, culprit)
        return self._recording(done, outcome, wall, cpu)

    def _first_row(self) -> None:
        """Record the start; a part may refuse outputs before its first step."""
        refused = get_all(self.prepared.layout, self.history, self.record.values, 0)
        if refused >= 0:
            name = self.network.parts[refused].name
            self.notes = (
                *self.notes,
                f"{name} refuses to give all of its outputs before its first step: at 0 s what "
                "nothing is connected to is recorded as NaN",
            )
        self.others.sample(1)

    def _until_others(self, done: int, count: int) -> int:
        """Steps of the loop until signals of other types are wanted."""
        if self.others.connected:
            return 1
        return min(count, self.record.until_row(done)) if self.others.recorded else count

    def _exchange_others(self, done: int) -> int:
        """Record signals of other types, and bring them to their inputs; a status of the loop."""
        try:
            self.others.sample(self.record.complete(done))
            if self.others.connected:
                take = self.others.exchange if done < self.grid.count else self.others.collect
                take()
        except FmuError as error:
            self.refusal = str(error)
            return REFUSED
        return DONE

    def _correct_start(self) -> None:
        """Add to the first values of connected outputs what they lack."""
        names, layout = connected_outputs(self.network), self.prepared.layout
        for (p, name), offset in self.start_offsets.items():
            if name not in names[p]:
                continue
            i = layout.output_first[p] + names[p].index(name)  # rates follow, which predict reads
            self.history[0, i] += offset
            self.record.values[0, layout.output_record[i]] += offset

    def _advance(self, start: int, count: int) -> tuple[int, int, int]:
        grid = self.grid
        chunk = Chunk(
            0.0, grid.step, start, count, self.record.values, grid.every, self.watch.monitor,
            self.record.first,
        )  # fmt: skip
        return self.prepared.run(self.history, chunk)

    def _recording(self, done: int, outcome: Outcome, wall: float, cpu: float) -> Recording:
        kept, record_step = self.rows.finish(done, outcome)
        rows = self.rows
        notes = wrapped_angles(
            rows.names, rows.recorded, self.network.exchanged, kept.time, kept.values
        )
        passes = zip((p.name for p in self.network.parts), self.prepared.passes(done), strict=True)
        return Recording(
            time=kept.time,
            values=kept.values,
            names=rows.names,
            units=rows.units,
            outcome=outcome,
            step=self.mean_step(done),
            record_step=record_step,
            macro_steps=self.prepared.macro_steps(done),
            passes=dict(passes),
            rollbacks=self.prepared.rollbacks,
            wall_seconds=wall,
            cpu_seconds=cpu,
            notes=(
                *self.network.notes, *self.notes, *self.loop_notes, *self.prepared.notes, *notes
            ),
            steps=self.prepared.steps,
            energy=self.watch.report() if done else None,
            slow={self.network.parts[p].name: m for p, m in self.network.slow.items()},
            others=kept.others,
            other_units=self.others.units,
            estimate=self.prepared.estimate,
        )  # fmt: skip

    def mean_step(self, done: int) -> float:
        """Macro step, or its mean [s]."""
        return self.grid.step * (done / max(self.prepared.macro_steps(done), 1) if done else 1)

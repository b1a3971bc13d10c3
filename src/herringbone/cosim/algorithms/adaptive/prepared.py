"""A network laid out for `li` with an adaptive macro step."""

from collections.abc import Mapping, Sequence

import numpy as np

from herringbone.cosim.algorithms.adaptive.aimed import Aimed
from herringbone.cosim.algorithms.adaptive.control import step_control
from herringbone.cosim.algorithms.adaptive.figures import (
    error_estimate,
    longest_steps,
    step_statistics,
)
from herringbone.cosim.algorithms.adaptive.rung_jacobians import RungJacobians
from herringbone.cosim.algorithms.iterated import SMALLEST, PreparedNodes
from herringbone.cosim.algorithms.jacobian import PREDICTION, CouplingError, StepRefusedError
from herringbone.cosim.algorithms.prepared import PreparedRun
from herringbone.cosim.checkpoint.run_state import Arrays, arrays_of, put_arrays
from herringbone.cosim.layouts.adaptive import (
    ACCEPTED,
    BEFORE,
    BEFORE_THAT,
    CULPRIT,
    MISSED,
    MISSED_NOW,
    NEEDED,
    OWN,
    ROWS,
    SCALED,
    USED,
    WANTED,
    Adaptive,
)
from herringbone.cosim.layouts.inner_stepping import NO_INNER, InnerStepping
from herringbone.cosim.layouts.layout import Chunk
from herringbone.cosim.layouts.measured import channel_outputs
from herringbone.cosim.layouts.nodes import Buffers, Control, new_buffers
from herringbone.cosim.layouts.starts import Starts
from herringbone.cosim.loops.adaptive_step.ladder import RUNGS, TICKS
from herringbone.cosim.loops.adaptive_step.loop import STEP_LIMIT, run_adaptive
from herringbone.cosim.loops.adaptive_step.step_error import LARGEST
from herringbone.cosim.loops.common import COUPLING_FAILED, DONE
from herringbone.cosim.loops.nodes import REFRESH
from herringbone.cosim.rows.record import Grid, GrowingRecord
from herringbone.cosim.rows.recording import ErrorEstimate, StepStatistics
from herringbone.cosim.structure.network import Network

RESIDUAL_SHARE = 1.0
"""Share of the tolerance that the corrections may leave."""


class PreparedAdaptive(PreparedNodes):
    """A network laid out for steps on a ladder; its grid counts ticks.

    The interface Jacobian is computed by differences on the first rung. On other rungs
    S(h) = a h + b h^2 (dampers, and springs and inertias) is fitted to the nearest ones that are
    known, until the corrections that this costs are as many as the passes of a Jacobian.

    Args:
        network: parts and connections.
        degree: p.
        full_order: convergence order with nodes at all parts.
        corrections: how many at least.
        most: how many at most.
        tolerance: relative error that is asked for.

    Attributes:
        inner: the bodies' own integration, of which the error takes account.
        channels: patterns of the recorded outputs whose errors count, by group.
    """

    def __init__(
        self,
        network: Network,
        degree: int,
        full_order: int,
        *,
        corrections: int,
        most: int,
        tolerance: float,
    ) -> None:
        super().__init__(
            network, degree, full_order, newton=True, corrections=corrections, most=most
        )
        self.tolerance = tolerance
        self._by_rung = RungJacobians()
        self._adaptive: Adaptive | None = None
        self._record = GrowingRecord(0)
        self._grid = Grid(0.0, 0, 0)
        self._aimed = Aimed(tolerance)
        self.inner: InnerStepping = NO_INNER
        self.channels: Mapping[str, Sequence[str]] = {}

    def suit(
        self, tolerance: float | None, inner: InnerStepping, channels: Mapping[str, Sequence[str]]
    ) -> None:
        """Measure steps by inner steps and channels, too; the tolerance is the algorithm's own."""
        del tolerance
        self.inner, self.channels = inner, channels

    def grid(self, grid: Grid) -> Grid:
        """The same end and records in ticks; the grid's step is the largest."""
        self._grid = Grid(grid.step / TICKS, grid.count * TICKS, grid.every * TICKS)
        return self._grid

    def record(self, grid: Grid, columns: int, window: int | None = None) -> GrowingRecord:
        """Rows as the steps come, or at equal distances."""
        del grid
        self._record = GrowingRecord(columns, window)
        return self._record

    def macro_steps(self, done: int) -> int:
        """Macro steps that were accepted."""
        del done
        return int(self._adaptive.state[ACCEPTED]) if self._adaptive else 0

    @property
    def steps(self) -> StepStatistics | None:
        """Macro steps by their length."""
        return step_statistics(self._adaptive, self._grid.step) if self._adaptive else None

    @property
    def adaptive(self) -> Adaptive | None:
        """What the loop works on beside; None if the run has not begun."""
        return self._adaptive

    @property
    def estimate(self) -> ErrorEstimate | None:
        """Error of the run so far, see `error_estimate`."""
        return error_estimate(self._adaptive, self.tolerance) if self._adaptive else None

    @property
    def culprit(self) -> str:  # type: ignore[override]  # it depends on the run
        """The unknown that missed what is aimed at, if one did."""
        return self._aimed.culprit

    @property
    def notes(self) -> tuple[str, ...]:  # type: ignore[override]  # it depends on the run
        """Downgrades; and steps that could not be made small enough, or as long as it would do."""
        if self._adaptive is None:
            return self._downgrades
        missed = int(self._adaptive.state[MISSED])
        if not missed:
            line = longest_steps(self._adaptive, self._grid, self.tolerance)
            return (*self._downgrades, *filter(None, (line,)))
        return (*self._downgrades, self._aimed.line(missed, self._grid.step))

    def _begin(self, history: np.ndarray) -> tuple[Buffers, Adaptive]:
        """What the loop works on, at the start."""
        buffers = new_buffers(self.nodes, self.network.parts, history)
        found = channel_outputs(self.network, self.channels)
        self._downgrades += tuple(
            f"no part takes anything of '{group}': the step is not measured by these channels"
            for group in self.channels
            if group not in found
        )
        control = step_control(
            self,
            buffers,
            self._grid,
            tolerance=self.tolerance,
            channels=found,
            inner=self.inner,
            times=self._record.row_times,
        )
        return buffers, control

    def saved(self) -> Arrays:
        """See `PreparedRun`; rows and their times are the record's."""
        found = super().saved() | arrays_of("adaptive", self._adaptive)
        found |= arrays_of("inner", self._adaptive and self._adaptive.inner)
        del found["adaptive.times"]
        return found | self._by_rung.saved() | self._aimed.saved()

    def put(self, saved: Mapping[str, np.ndarray]) -> None:
        """See `PreparedRun`."""
        super().put(saved)
        put_arrays("adaptive", self._adaptive, saved)
        put_arrays("inner", self._adaptive and self._adaptive.inner, saved)
        self._by_rung.put(saved)
        self._aimed.put(saved)
        if self._adaptive is not None:
            self._adaptive = self._adaptive._replace(tolerance=self._aimed.now)

    def run_from(
        self, starts: Starts, begin: int, history: np.ndarray, chunk: Chunk
    ) -> tuple[int, int, int]:
        """See `PreparedRun`."""
        return PreparedRun.run_from(self, starts, begin, history, chunk)

    def run(self, history: np.ndarray, chunk: Chunk) -> tuple[int, int, int]:
        """Run up to the end of the chunk, which counts ticks; see `loops.stages.run_stages`."""
        if self._buffers is None or self._adaptive is None:
            self._buffers, self._adaptive = self._begin(history)
            status = self._correct(self._buffers, self._adaptive, chunk.start, chunk.h)
            if status != DONE:
                return status, chunk.start, -1
        done, end = chunk.start, chunk.start + chunk.count
        while True:
            self._record.make_room()
            self._adaptive = self._adaptive._replace(times=self._record.row_times)
            self._adaptive.state[ROWS] = self._record.rows
            status, done, culprit = run_adaptive(
                self.layout,
                self.nodes,
                self._buffers,
                Control(self.corrections, self.most, RESIDUAL_SHARE * self._aimed.now, np.inf,
                        PREDICTION),
                self._adaptive,
                chunk._replace(start=done, count=max(0, end - done), records=self._record.values),
            )  # fmt: skip
            self._record.rows = int(self._adaptive.state[ROWS])
            if status == REFRESH:
                status = self._correct(self._buffers, self._adaptive, done, chunk.h)
            if status == STEP_LIMIT:
                status = self._loosened(done * chunk.h)
            if status != DONE or done >= end:
                return status, done, culprit

    def _correct(self, buffers: Buffers, adaptive: Adaptive, done: int, tick: float) -> int:
        """Correction of the rung in use; a status of the loop."""
        rung = int(adaptive.state[USED])
        t, h = done * tick, RUNGS[rung] * tick
        own = self._by_rung.none or adaptive.ready[rung] == NEEDED
        try:
            if own:
                self._by_rung.keep(rung, self._measured(buffers, adaptive, rung, t, h))
                adaptive.owed[rung] = 0
            adaptive.corrections[rung] = self._by_rung.correction(rung, t, h)
        except StepRefusedError as error:
            if rung == 0:
                self.problem = str(error)
                return COUPLING_FAILED
            adaptive.rejected[rung] += 1
            adaptive.state[WANTED] = rung - 1
            return DONE
        except CouplingError as error:
            self.problem = str(error)
            return COUPLING_FAILED
        adaptive.ready[rung] = OWN if own else SCALED
        return DONE

    def _measured(
        self, buffers: Buffers, adaptive: Adaptive, rung: int, t: float, h: float
    ) -> np.ndarray:
        self.jacobians += 1
        buffers.spacing[:] = adaptive.state[[BEFORE, BEFORE_THAT]] / RUNGS[rung]
        size = np.maximum(adaptive.moments[LARGEST, self.nodes.group], SMALLEST)
        return self.jacobian.measure(buffers, size, t, h, int(adaptive.state[ACCEPTED]) + 1)

    def _loosened(self, t: float) -> int:
        """Go on with twice the tolerance, as with a fixed step; a status of the loop."""
        if self._adaptive is None:
            return STEP_LIMIT
        adaptive = self._adaptive
        if not self._aimed.double(self._culprit(adaptive), t, self._grid.step):
            self.problem = self._aimed.missed
            return STEP_LIMIT
        adaptive.state[MISSED_NOW] = 0
        self._adaptive = adaptive._replace(tolerance=self._aimed.now)
        return DONE

    def _culprit(self, adaptive: Adaptive) -> str:
        """Who errs most of the unknowns; where there is none, channels alone are measured."""
        if not self.nodes.unknown.size:
            return "what is recorded"
        p, name = self.jacobian.owners[self.nodes.unknown[int(adaptive.state[CULPRIT])]]
        return f"{self.network.parts[p].name}.{name}"

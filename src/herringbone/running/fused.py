"""A run of a system whose parts are fused: condensed into one core, without any coupling."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from threadpoolctl import threadpool_limits

from herringbone.analysis.accuracy.apart import apart
from herringbone.analysis.twin.condensed.solution import CoreStopped
from herringbone.analysis.twin.fused.core import Core, Steps, closeness, endings_of
from herringbone.analysis.twin.fused.course import Course
from herringbone.analysis.twin.fused.measured import DEGREES, Measured, measured, suited
from herringbone.core import Outcome, OutcomeKind, ParameterError, StructureError
from herringbone.core.activity import activity
from herringbone.core.declaring.table import KeptRows, TableColumns
from herringbone.core.names import matches_any
from herringbone.core.places.files import same_folder
from herringbone.cosim.interrupt import InterruptFlag
from herringbone.cosim.rows.record import Grid, UniformRecord
from herringbone.cosim.rows.recording import CoreStatistics, Recording
from herringbone.cosim.rows.stream import Streaming
from herringbone.cosim.simulation import make_grid
from herringbone.cosim.structure.system import System
from herringbone.result.result import Result
from herringbone.result.verification import Verification
from herringbone.running.output.run_output import RunOutput
from herringbone.running.reporting.progress import Progress, told
from herringbone.running.reporting.run_result import (
    judged,
    make_result,
    start_of,
    with_coupling_row,
)
from herringbone.scenes import Scene

TOLERANCE = 1e-3
"""Error of a run for which nothing else is asked."""
KIND = "fused"
"""What stands in place of the kind of FMUs."""
_SELDOM = 1.0
"""Wall time [s] after which rows are handed on, however few they are."""
_CHECKPOINT = 5.0
"""Wall time [s] between two checkpoints."""


@dataclass(frozen=True)
class FusedAsked:
    """What is asked of a fused run; None: chosen.

    Attributes:
        step: base step [s].
        tolerance: for which the step is chosen.
        degree: of the polynomials, with a step.
        record: patterns of outputs, or groups of channels, that are recorded; all if empty.
        notes: lines that the user should read.
    """

    step: float | None = None
    tolerance: float | None = None
    record: tuple[str, ...] = ()
    degree: int = DEGREES[0]
    notes: tuple[str, ...] = ()


def refuse_strangers(system: System) -> None:
    """Check that all parts are components, whose equations are known.

    Raises:
        StructureError: some are foreign FMUs.
    """
    if system.foreign_parts:
        raise StructureError(
            f"fuse: {', '.join(system.foreign_parts)}: the equations of foreign FMUs are not "
            "known, so that they cannot be fused; run without fuse"
        )


def fused(
    system: System,
    scene: Scene,
    asked: FusedAsked,
    progress: bool | Progress = False,
    recorded: Callable[[Result], None] | None = None,
    output: RunOutput | None = None,
) -> Result:
    """Run a prepared system as one core.

    Args:
        system: with all values.
        scene: with duration and record step.
        asked: of the run.
        progress, recorded: see `api.run`.
        output: folder into which rows go while the run goes on; None: they stay in memory.

    Raises:
        StructureError: a part is foreign, or cannot be condensed.
        ParameterError: no step reaches the tolerance, or what is to be recorded is not there.
        HerringboneError: rows cannot be written.
    """
    with same_folder(), threadpool_limits(limits=1, user_api="blas"):
        with activity(f"fusing the parts of {system.name}"):
            core = Core(system)
            columns = core.chosen(asked.record)
            trial = _trial(core, asked, scene.t_end)
        system = _with_channels(system, columns)
        grid = make_grid(scene.t_end, scene.record_step, scene.record_step)
        lines = [*asked.notes, *_lines(core, asked, trial)]
        streaming = None
        if output is not None:
            start = start_of(system, scene, KIND, KIND, grid, lines)
            streaming = output.stream(start)
        with told(progress, f"simulating {1e3 * scene.t_end:g} ms of {system.name}") as tell:
            recording = _FusedRun(core, trial, columns, grid, streaming).go(tell)
    every = make_result(system, scene, KIND, KIND, recording, lines)
    every = replace(every, verification=_verification(trial))
    every = judged(every, None)
    result = every if output is None else output.seen(every)
    if recorded:
        recorded(result)
    return result


def _with_channels(system: System, columns: Sequence[str]) -> System:
    """The system with the patterns of its channels that match recorded outputs."""
    found = {
        group: tuple(p for p in patterns if any(matches_any(endings_of(c), [p]) for c in columns))
        for group, patterns in system.channels.items()
    }
    return replace(system, channels={group: own for group, own in found.items() if own})


def verified_by_half(
    result: Result, system: System, scene: Scene, asked: FusedAsked, progress: bool | Progress
) -> Result:
    """The result with its error by half the step, over the whole run.

    Args:
        result: of the run.
        system, scene, asked: of it.
        progress: see `api.run`.

    Raises:
        HerringboneError: see `fused`.
    """
    core = result.info.core or {}
    step = 0.5 * core["step"]
    finer = fused(system, scene, replace(asked, step=step, degree=int(core["degree"])), progress)
    found = apart(result, finer)
    how = "by half the step, over the whole run"
    verification = Verification(found.groups, found.worst, found.worst_difference, step, how)
    return with_coupling_row(replace(result, verification=verification))


def _trial(core: Core, asked: FusedAsked, t_end: float) -> Measured:
    """Steps that were asked for, or that a tolerance needs, with their error."""
    tolerance = asked.tolerance or TOLERANCE
    if asked.step is None:
        return suited(core, tolerance, t_end)
    steps = Steps(asked.step, asked.degree, closeness(tolerance))
    return measured(core, steps, t_end)


def _lines(core: Core, asked: FusedAsked, trial: Measured) -> list[str]:
    tolerance, errors = asked.tolerance or TOLERANCE, f"{100.0 * trial.error:.2g} %"
    steps = f"steps of {1e6 * trial.steps.length:.4g} us, degree {trial.steps.degree}"
    over = f"the first {1e3 * trial.window:.3g} ms"
    if asked.step is None:
        lines = [f"fused: {steps}, for an error of {100.0 * tolerance:g} %: {errors} over {over}"]
    else:
        lines = [f"fused: {steps}, as asked for: error {errors} over {over}"]
    if core.missing:
        lines.append(
            f"not recorded, as only steps of the parts make them: {', '.join(core.missing)}"
        )
    return lines


def _verification(trial: Measured) -> Verification | None:
    if not trial.groups:
        return None
    how = f"by half the step, over the first {1e3 * trial.window:.3g} ms"
    half = 0.5 * trial.steps.length
    return Verification(trial.groups, trial.worst, trial.worst_error, half, how)


class _FusedRun:
    """One run: portions of steps, how it ends, and the record."""

    def __init__(
        self,
        core: Core,
        trial: Measured,
        columns: Sequence[str],
        grid: Grid,
        streaming: Streaming | None,
    ) -> None:
        self._core, self._trial, self._columns, self._grid = core, trial, columns, grid
        self._times = np.arange(grid.count + 1) * grid.step
        self._course = Course(core, self._times, trial.steps, columns)
        self._streaming = streaming
        self._units = tuple(core.unit(name) for name in columns)
        self._waiting: list[tuple[np.ndarray, np.ndarray]] = []
        if streaming is None:
            self._values = UniformRecord(grid, len(columns)).values
        else:
            table = TableColumns(tuple(columns), self._units, {}, {})
            streaming.sink.begin(table, grid.count + 1)
        self._done, self._wall = 0, 0.0

    def go(self, progress: Progress | None) -> Recording:
        """Portion after portion."""
        course, stopped = self._course, None
        if self._streaming and self._streaming.checkpoint is not None:
            saved = self._streaming.checkpoint
            course.put(saved)
            self._done, self._wall = int(saved["rows"]), float(saved["wall"])
        begin = taken = flushed = time.perf_counter()
        before = self._wall
        with InterruptFlag() as flag:
            while not course.ended and not flag.raised and stopped is None:
                try:
                    self._take(*course.advance())
                except CoreStopped as error:
                    stopped = error
                now = time.perf_counter()
                self._wall = before + now - begin
                if now - flushed > _SELDOM:
                    self._flush()
                    flushed = now
                if now - taken > _CHECKPOINT and stopped is None:
                    self._checkpoint()
                    taken = now
                if progress:
                    progress(float(self._times[max(course.row - 1, 0)]), float(self._times[-1]))
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
            message = f"stopped at {reached:g} s; results so far are kept"
            return Outcome(OutcomeKind.INTERRUPTED, reached, message=message)
        return Outcome(OutcomeKind.COMPLETED, reached)

    def _recording(self, outcome: Outcome) -> Recording:
        if self._streaming is None:
            kept = KeptRows(self._times[: self._done], self._values[: self._done], {})
        else:
            kept = self._streaming.sink.kept()
        counts, steps = self._course.counts, self._trial.steps
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
            (),
            core=CoreStatistics(steps.degree, length, **counts),
        )


def check_coupling(*, algorithm: object, slow: object, fmu: bool, probe: bool) -> None:
    """Refuse what is asked of a coupling, which a fused run has not.

    Raises:
        ParameterError: something is.
    """
    given = {
        "algorithm": algorithm is not None,
        "slow": bool(slow),
        "fmu": fmu,
        "no_probe": not probe,
    }
    if names := [name for name, is_given in given.items() if is_given]:
        raise ParameterError(
            f"fuse: {', '.join(names)}: of a coupling, and a fused system has none; leave it out"
        )


def check_record(record: Sequence[str], *, fuse: bool) -> None:
    """Refuse chosen outputs of a run that is not fused; raises ParameterError."""
    if record and not fuse:
        raise ParameterError("record: only a fused run records chosen outputs; add fuse")

"""A run of a system whose parts are fused: condensed into one core, without any coupling."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from herringbone.analysis.accuracy.apart import apart
from herringbone.analysis.twin.fused.core import Core, Steps, closeness
from herringbone.analysis.twin.fused.later import later, watched
from herringbone.analysis.twin.fused.measured import DEGREES, WINDOW, Measured, measured, suited
from herringbone.core import ParameterError, StructureError
from herringbone.core.caching.remembered import Remembered
from herringbone.core.places.files import same_folder
from herringbone.core.process.activity import activity
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.rows.record import Grid
from herringbone.cosim.rows.recording import Recording
from herringbone.cosim.simulation import make_grid
from herringbone.cosim.structure.system import System
from herringbone.cosim.tolerance import DEFAULT_TOLERANCE
from herringbone.result.budget import BudgetRow
from herringbone.result.result import Result
from herringbone.result.verification import HALVED, Verification, error_unknown
from herringbone.running.fused.beside import KIND, with_channels
from herringbone.running.fused.known_error import KnownError
from herringbone.running.fused.loop import FusedRun
from herringbone.running.operating.lean import refuse_frozen, with_row
from herringbone.running.output.run_output import RunOutput
from herringbone.running.reporting.progress import Progress, told
from herringbone.running.reporting.run_result import (
    judged,
    make_result,
    start_of,
    with_coupling_row,
)
from herringbone.scenes import Scene

OVER_ALL = "the error over the whole run"
_trials: Remembered[Measured] = Remembered(64)
"""By system, what is left out, channels that are measured, and what is asked."""


@dataclass(frozen=True)
class FusedAsked:
    """What is asked of a fused run; None: chosen.

    Attributes:
        step: base step [s].
        tolerance: for which the step is chosen.
        record: patterns of outputs, or groups of channels, that are recorded; all if empty.
        notes: lines that the user should read.
        left_out: row of the error budget, of what the model leaves out.
    """

    step: float | None = None
    tolerance: float | None = None
    record: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    left_out: BudgetRow | None = None


def refuse_strangers(system: System) -> None:
    """Check that all parts are components, whose equations are known.

    Raises:
        StructureError: some are foreign FMUs.
    """
    if system.foreign_parts:
        raise StructureError(
            f"fuse: {', '.join(system.foreign_parts)}: the equations of foreign FMUs are not "
            "known, so that they cannot be in the core"
        )


def fused(
    system: System,
    scene: Scene,
    asked: FusedAsked,
    progress: bool | Progress = False,
    recorded: Callable[[Result], None] | None = None,
    output: RunOutput | None = None,
    *,
    verify: bool = False,
) -> Result:
    """Run a prepared system as one core.

    Args:
        system: with all values.
        scene: with duration and record step.
        asked: of the run.
        progress, recorded: see `api.run`.
        output: folder into which rows go while the run goes on; None: they stay in memory.
        verify: its error over the whole run is found after that, see `verified_by_half`.

    Raises:
        StructureError: a part cannot be condensed.
        ParameterError: no step reaches the tolerance, or what is to be recorded is not there.
        HerringboneError: rows cannot be written.
    """
    refuse_frozen(scene)
    with same_folder(), one_blas_thread():
        with activity(f"fusing the parts of {system.name}"):
            core = Core(system, lean=scene.model.left_out)
            columns = core.chosen(asked.record)
            trial = _trial(core, asked, scene.t_end)
        system = with_channels(system, columns)
        known, streaming = KnownError(trial), None
        if output is not None:
            start = start_of(system, scene, KIND, KIND, _grid(scene), _lines(core, asked, known))
            streaming = output.stream(start)
        marks = () if verify else watched(scene.t_end)
        run = FusedRun(core, trial.steps, columns, _grid(scene), streaming, marks)
        recording = _marched(run, system, scene, progress)
        if recording.outcome.completed and not verify:
            with activity(f"measuring the error of the steps of {system.name}"):
                known = KnownError(trial, later(core, trial, scene.t_end, run.marks))
    every = make_result(system, scene, KIND, KIND, recording, _lines(core, asked, known))
    every = replace(every, verification=known.verification)
    every = with_row(judged(every, system, None), asked.left_out)
    result = every if output is None else output.seen(every)
    if recorded:
        recorded(result)
    return result


def _marched(run: FusedRun, system: System, scene: Scene, progress: bool | Progress) -> Recording:
    with told(progress, f"simulating {1e3 * scene.t_end:g} ms of {system.name}") as tell:
        return run.go(tell)


def _grid(scene: Scene) -> Grid:
    return make_grid(scene.t_end, scene.record_step, scene.record_step)


def verified_by_half(
    result: Result, system: System, scene: Scene, asked: FusedAsked, progress: bool | Progress
) -> Result:
    """The result with its error by half the step, over the whole run; a line if that ends early.

    Args:
        result: of the run.
        system, scene, asked: of it.
        progress: see `api.run`.

    Raises:
        HerringboneError: see `fused`.
    """
    taken = result.info.core or {}
    step = 0.5 * taken["step"]
    steps = Steps(step, int(taken["degree"]), closeness(asked.tolerance or DEFAULT_TOLERANCE))
    with same_folder(), one_blas_thread():
        core = Core(system, lean=scene.model.left_out)
        columns = core.chosen(asked.record)
        system = with_channels(system, columns)
        run = FusedRun(core, steps, columns, _grid(scene), None)
        recording = _marched(run, system, scene, progress)
    if not recording.outcome.ended_well:
        return result.noted(error_unknown(recording.outcome, HALVED, OVER_ALL))
    found = apart(result, make_result(system, scene, KIND, KIND, recording, ()))
    how = "by half the step, over the whole run"
    verification = Verification(found.groups, found.worst, found.worst_difference, step, how)
    return with_coupling_row(replace(result, verification=verification))


def _trial(core: Core, asked: FusedAsked, t_end: float) -> Measured:
    """Steps that were asked for, or that a tolerance needs, with their error."""
    tolerance = asked.tolerance or DEFAULT_TOLERANCE

    def tried() -> Measured:
        if asked.step is None:
            return suited(core, tolerance, t_end)
        steps = Steps(asked.step, DEGREES[0], closeness(tolerance))
        return measured(core, steps, min(t_end, WINDOW))

    key = core.content, core.lean, repr(core.groups()), asked.step, tolerance, t_end
    return _trials(key, tried)


def _lines(core: Core, asked: FusedAsked, known: KnownError) -> list[str]:
    return [*asked.notes, *known.lines(asked.step, asked.tolerance), *core.unrecorded]


def check_kind(*, fmu: bool) -> None:
    """Refuse a kind of FMUs, which fused parts are not; raises ParameterError."""
    if fmu:
        raise ParameterError("fuse: fmu: of a coupling of own parts, which are fused; leave it out")


def check_coupling(*, algorithm: object, slow: object, probe: bool) -> None:
    """Refuse what is asked of a coupling, which a fused run has not.

    Raises:
        ParameterError: something is.
    """
    given = {
        "algorithm": algorithm is not None,
        "slow": bool(slow),
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

"""Running a system: from names and options to a result."""

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path

from herringbone.analysis.steady.operating_point import Point
from herringbone.core import ParameterError
from herringbone.core.given import check_called
from herringbone.core.process.activity import tell
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.algorithms import AUTO, LI, Algorithm, parse_algorithm
from herringbone.cosim.cell.policy import foreign_fmu_policy
from herringbone.cosim.simulation import check_grid, check_records
from herringbone.cosim.structure.system import System
from herringbone.cosim.tolerance import check_tolerance
from herringbone.fmi.kind import AUTO as AUTO_FMU
from herringbone.result.result import Result
from herringbone.running.coupling_choice import Asked
from herringbone.running.fused.fused import (
    FusedAsked,
    check_coupling,
    check_kind,
    check_record,
)
from herringbone.running.housings.fmu_remarks import HousingRemarks, with_remarks
from herringbone.running.operating.by_hand import said_by_hand
from herringbone.running.operating.commanded import operated, own_point
from herringbone.running.operating.lean import certified_row, changed_by, lean_notes
from herringbone.running.output.by_script import placed
from herringbone.running.output.run_output import RunOutput
from herringbone.running.pairs.gears import Gear
from herringbone.running.prepared import Wishes, prepared
from herringbone.running.prepared_runs import Heard, coupled_run, fused_run
from herringbone.running.reporting.progress import Progress
from herringbone.running.settling.held import Wanted
from herringbone.scenes import Scene


def run(
    system: str | Path | System,
    *,
    scene: str | Path | Scene | None = None,
    speed: float | None = None,
    torque: float | None = None,
    algorithm: str | Algorithm | None = None,
    step: float | None = None,
    tolerance: float | None = None,
    slow: Mapping[str, int] | None = None,
    t_end: float | None = None,
    record_step: float | None = None,
    start: str | None = None,
    fmu: str = AUTO_FMU,
    replace_parts: Mapping[str, str | Path] | None = None,
    values: Mapping[str, float | str | Path] | None = None,
    gear: Gear | Mapping[str, Gear] | None = None,
    housing: str | Path | Mapping[str, str | Path] | None = None,
    probe: bool = True,
    in_process: bool | None = None,
    call_deadline: float | None = None,
    longest_trial: int | None = None,
    most_trial_steps: int | None = None,
    reference: bool = False,
    verify: bool = False,
    fuse: bool = False,
    record: str | Sequence[str] = (),
    progress: bool | Progress = False,
    recorded: Callable[[Result], None] | None = None,
    output: str | PathLike[str] | RunOutput | None = None,
    overwrite: bool = False,
) -> Result:
    """Run a system.

    Args:
        system: name of a shipped system, folder with system.toml, .ssp file, or a System.
        scene: name or file of a scene; the system's "loaded" if not given.
        speed: of the set point that the system declares, at its own shaft (most often the
            pinion's; in `turbine` the wheel's), or of the pinion if nothing is joined to its gear
            pair [rad/s]; the scene's if not given, as in `herringbone.sweep`.
        torque: likewise [N m].
        algorithm: coupling algorithm, such as `LI(degree=3)` or "li:degree=3"; "auto", the
            default, takes li if all parts can repeat a step, and jacobi otherwise; see `step` for
            what it is asked.
        step: communication step size [s]; the algorithm's default if not given, or, if nothing
            else is said and all parts are foreign, or of this package with a gear pair, what a
            tolerance of 1e-3 needs. With a tolerance the largest one; an adaptive step goes down
            to 1/200 of it.
        tolerance: relative error (see `analysis.accuracy.error`) for which `li` adapts its step, as
            in "li:tolerance=1e-3"; with foreign parts the step is fixed, and found by several runs
            with any algorithm, see `running.steps.step_search`.
        slow: heavy bodies that step once in several macro steps, and in how many, such as
            {"motor": 5}; the others see their predicted motion.
        t_end: duration [s]; the scene's if not given.
        record_step: time between records [s]; the scene's if not given. With a tolerance steps end
            at records, which are 50 us apart if not given, and 0.1 ms above a tolerance of 1e-3.
        start: "equilibrium", "ramp" or "rest"; the scene's if not given.
        fmu: "native", "python", "in-process" (the same kernels without FMU), or "auto": native
            FMUs if there is a C compiler, Python FMUs otherwise.
        replace_parts: FMU files by instance name; a housing is tested against the contract of
            housings first, and what it breaks is told, and becomes a note; a run with one that
            makes energy has not completed.
        values: variables to set, by `instance.variable`.
        gear: gear file (TOML or REXS) or job of the gear pair, whose values all parts get that
            belong to it; of several pairs: by path.
        housing: folder of modal data, dimensions of a welded housing (TOML) or FMU; of several
            housings: by path.
        probe: find out by trial steps what foreign FMUs are, see `running.foreign`; False:
            they are taken by what they declare.
        in_process: True: load foreign FMUs into this process, where their faults are faults of the
            run; False, the default on Linux: each runs in a child process, see `cosim.cell`.
        call_deadline: longest time that a call of an FMU in a child process may take [s]; 60 s if
            not given.
        longest_trial: steps of a trial in the test of what a housing FMU must do; longer ones are
            left out. All if not given.
        most_trial_steps: steps of all trials of a foreign FMU together, before the run; what they
            do not tell stays unknown, and a line says so. Any number if not given.
        reference: also solve the monolithic twin, and report the errors against it.
        verify: also run with half the macro step and half the inner steps, and report how far
            apart both are, see `running.steps.verification`; for systems that have no twin.
        fuse: condense all parts that are components of this package into one core. Without others
            it is marched alone; `step` is its base step then, and `tolerance`, 1e-3 if neither is
            given, the error for which it is chosen, see `docs/fused.md`. Beside foreign FMUs it is
            a part that is coupled with them.
        record: of a fused run, groups of channels and patterns of outputs (`*`, `?`) to be
            recorded; all if none is given.
        progress: True for a bar; or called with the simulated time reached and its end [s].
        recorded: called with the result as soon as the run has ended, before the parts are
            terminated and freed, which a part may not survive; errors against the twin, and
            why a run is unstable, are found after that, and are in the result that is returned.
        output: folder for the results, into which rows go while the run goes on, and which
            `herringbone.load` and the commands read; pictures are drawn by `herringbone plot`. Of a
            long run the result then has the last records only, see `docs/results_folder.md`. None:
            nothing is written.
        overwrite: results of other settings in the folder may be replaced.

    Returns:
        The result; a run that ends early or is unstable is an outcome of it, not an exception.

    Raises:
        HerringboneError: something about the input is wrong.
    """
    record = (record,) if isinstance(record, str) else record
    check_record(record, fuse=fuse)
    check_called("progress", progress)
    check_kind(fmu=fuse and fmu != AUTO_FMU)
    coupling = _asked_for(algorithm)
    if tolerance is not None:
        check_tolerance(tolerance)
    remarks: list[HousingRemarks] = []

    def remarked(own: HousingRemarks) -> None:
        remarks.append(own)
        for line in own.lines:
            tell(line)

    wishes = Wishes(
        t_end, record_step, start, values or {}, gear, housing, replace_parts or {}, lean=fuse,
        probe=probe,
    )  # fmt: skip
    with (
        one_blas_thread(),
        foreign_fmu_policy(
            in_process=in_process,
            deadline=call_deadline,
            longest_trial=longest_trial,
            most_trial_steps=most_trial_steps,
        ),
        placed(output, recorded, overwrite=overwrite) as place,
    ):
        structure, chosen, notes = prepared(
            system,
            scene,
            operated(system, scene, wishes, speed, torque),
            check=lambda scene: _check_times(scene, step),
            remarked=remarked,
            trial_step=(step or (coupling or LI()).start_step) if probe else None,
            wanted=Wanted(coupling, step),
        )
        by_hand = said_by_hand(system, scene, wishes, Point(speed, torque))
        notes, left_out = notes + by_hand.notes, by_hand.row or certified_row(chosen.model)
        heard = Heard(progress, place.recorded, place.output)
        if fuse and not structure.foreign_parts:
            check_coupling(algorithm=algorithm, slow=slow, probe=probe)
            own = own_point(structure) if chosen.model else (None, None)
            said = (*notes, *lean_notes(chosen.model, changed_by(wishes), speed, torque, own))
            wanted = FusedAsked(step, tolerance, tuple(record), said, left_out)
            return place.complete(
                fused_run(structure, chosen, wanted, heard, reference=reference, verify=verify)
            )
        asked = Asked(
            fmu,
            coupling,
            step,
            tolerance,
            slow=slow,
            probe=probe,
            record_step=record_step,
            notes=notes,
            fuse=fuse,
            record=tuple(record),
            left_out=left_out,
        )
        found = coupled_run(structure, chosen, asked, heard, reference=reference, verify=verify)
        return place.complete(with_remarks(found, remarks))


def _check_times(scene: Scene, step: float | None) -> None:
    """Check durations of a run before anything takes long; raises ParameterError."""
    check_grid(scene.t_end, step, scene.record_step)
    check_records(scene.t_end, scene.record_step)


def _asked_for(algorithm: str | Algorithm | None) -> Algorithm | None:
    """The algorithm that was asked for; None for the automatic choice."""
    if algorithm is None or algorithm == AUTO:
        return None
    if isinstance(algorithm, str):
        return parse_algorithm(algorithm)
    if not isinstance(algorithm, Algorithm):
        raise ParameterError(
            f"algorithm = {algorithm!r:.60}: it takes a text or an object, 'li:degree=3' or "
            "LI(degree=3)"
        )
    return algorithm

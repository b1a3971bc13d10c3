"""Running a system: from names and options to a result."""

import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from herringbone.analysis.stability.diagnosis import diagnose
from herringbone.analysis.stability.limits import fastest_bond, warn_if_unstable
from herringbone.analysis.twin.monolithic import refuse_foreign_parts
from herringbone.core.activity import activity
from herringbone.core.energy_report import Verdict
from herringbone.core.files import same_folder
from herringbone.core.part import Part, closing_all
from herringbone.cosim.algorithms import (
    AUTO,
    LI,
    Algorithm,
    choose_algorithm,
    parse_algorithm,
    with_tolerance,
)
from herringbone.cosim.exit_guard import exit_guard
from herringbone.cosim.record import Grid
from herringbone.cosim.recording import Recording
from herringbone.cosim.simulation import check_grid, make_grid, simulate
from herringbone.cosim.structure.system import System
from herringbone.fmi.kind import AUTO as AUTO_FMU
from herringbone.fmi.kind import choose_kind
from herringbone.result.result import Result
from herringbone.running.foreign_parts import understood
from herringbone.running.gears import Gear
from herringbone.running.loading import instances, open_parts
from herringbone.running.prepared import Wishes, prepared
from herringbone.running.progress import Progress, told
from herringbone.running.run_result import compared, decimated, judged, make_result
from herringbone.scenes import Scene

_log = logging.getLogger(__name__)
_SAME = 1.0 - 1e-6


def run(
    system: str | Path | System,
    *,
    scene: str | Path | Scene | None = None,
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
    reference: bool = False,
    progress: bool | Progress = False,
    recorded: Callable[[Result], None] | None = None,
) -> Result:
    """Run a system.

    Args:
        system: name of a shipped system, folder with system.toml, .ssp file, or a System.
        scene: name or file of a scene; the system's "loaded" if not given.
        algorithm: coupling algorithm, such as `LI(degree=3)` or "li:degree=3"; "auto", the
            default, takes li if all parts can repeat a step, and jacobi otherwise.
        step: communication step size [s]; the algorithm's default if not given. With a tolerance
            the largest one, and the others go down to 1/200 of it.
        tolerance: relative error (see `analysis.accuracy.error`) for which `li` adapts its step, as
            in "li:tolerance=1e-3".
        slow: heavy bodies that step once in several macro steps, and in how many, such as
            {"motor": 5}; the others see their predicted motion.
        t_end: duration [s]; the scene's if not given.
        record_step: time between records [s]; the scene's if not given.
        start: "equilibrium", "ramp" or "rest"; the scene's if not given.
        fmu: "native", "python", "in-process" (the same kernels without FMU), or "auto": native
            FMUs if there is a C compiler, Python FMUs otherwise.
        replace_parts: FMU files by instance name; a housing is tested against the contract of
            housings first, and what it breaks becomes a note.
        values: variables to set, by `instance.variable`.
        gear: gear file (TOML or REXS) or job of the gear pair, whose values all parts get that
            belong to it; of several pairs: by path.
        housing: folder of modal data, dimensions of a welded housing (TOML) or FMU; of several
            housings: by path.
        probe: find out by trial steps what foreign FMUs are, see `running.foreign_parts`; False:
            they are taken by what they declare.
        reference: also solve the monolithic twin, and report the errors against it.
        progress: True for a bar; or called with the simulated time reached and its end [s].
        recorded: called with the result as soon as the run has ended, before the parts are
            terminated and freed, which a part may not survive; errors against the twin, and
            why a run is unstable, are found after that, and are in the result that is returned.

    Returns:
        The result; a run that ends early or is unstable is an outcome of it, not an exception.

    Raises:
        HerringboneError: something about the input is wrong.
    """
    coupling = _asked_for(algorithm, tolerance)
    wishes = Wishes(t_end, record_step, start, values or {}, gear, housing, replace_parts or {})
    structure, chosen, notes = prepared(
        system, scene, wishes, check=lambda scene: check_grid(scene.t_end, step, scene.record_step)
    )
    if reference:
        refuse_foreign_parts(structure)
    fmu, slower = choose_kind(fmu)
    lines = [*notes, *slower]
    with same_folder(), exit_guard(), closing_all(open_parts(structure, fmu)) as opened:
        trial = step or (coupling or LI()).start_step
        parts, said = understood(structure, opened, instances, trial) if probe else (opened, [])
        lines += said
        if coupling is None:
            coupling, why = _chosen_for(parts, tolerance, step)
            lines.append(why)
        asked, step = step, coupling.start_step if step is None else step
        lines += _stability_notes(structure, coupling, step, slow)
        grid = make_grid(chosen.t_end, step, step if reference else chosen.record_step)
        _log.info("%s, scene %s: %s, %s FMUs", structure.name, chosen.name, coupling, fmu)
        lines += _record_notes(record_step, coupling, grid)
        bond = fastest_bond(structure)
        what = f"simulating {1e3 * chosen.t_end:g} ms of {structure.name}"
        with told(progress, what) as tell:
            recording = simulate(
                structure, parts, coupling, grid, tell, bond_frequency=bond, slow=slow
            )
        lines += _step_notes(asked, coupling, recording)
        every = judged(make_result(structure, chosen, coupling, fmu, recording, lines), bond)
        _log_end(recording)
        result = decimated(every, chosen.record_step) if reference else every
        if recorded:
            recorded(result)
    if reference:
        result = compared(result, every, structure)
    if _unstable(recording):
        with activity(f"looking for what grows in {structure.name}, and for remedies"):
            why_unstable = diagnose(structure, coupling, recording.step)
        result = replace(result, info=replace(result.info, why=why_unstable))
    return result


def _asked_for(algorithm: str | Algorithm | None, tolerance: float | None) -> Algorithm | None:
    """The algorithm that was asked for; None for the automatic choice."""
    if algorithm is None or algorithm == AUTO:
        return None
    found = parse_algorithm(algorithm) if isinstance(algorithm, str) else algorithm
    return found if tolerance is None else with_tolerance(found, tolerance)


def _chosen_for(
    parts: Sequence[Part], tolerance: float | None, step: float | None
) -> tuple[Algorithm, str]:
    """The algorithm that suits the parts, and why."""
    found, why = choose_algorithm(parts, tolerance, step)
    return (found if tolerance is None else with_tolerance(found, tolerance)), why


def _stability_notes(
    system: System, algorithm: Algorithm, step: float, slow: Mapping[str, int] | None
) -> list[str]:
    """A line if the step is unstable; nothing is predicted with slow bodies.

    An adaptive step needs none: it finds the limit, and goes below.
    """
    if system.foreign_parts or algorithm.adaptive or slow:
        return []
    with activity(f"predicting whether {system.name} is stable"):
        warning = warn_if_unstable(system, algorithm, step)
    return [warning] if warning else []


def _record_notes(record_step: float | None, algorithm: Algorithm, grid: Grid) -> list[str]:
    """A line if records were asked for inside a communication step."""
    if record_step is None or record_step >= grid.step or algorithm.adaptive:
        return []
    return [f"record_step = {record_step:g} s: records are taken at communication points, every "
            f"{grid.step:g} s; use a shorter step for more"]  # fmt: skip


def _step_notes(asked: float | None, algorithm: Algorithm, recording: Recording) -> list[str]:
    """A line if the step that was asked for was shortened."""
    used = recording.step
    if asked is None or algorithm.adaptive or used >= _SAME * asked:
        return []
    return [f"step = {asked:g} s: shortened to {used:g} s, of which a whole number makes the end "
            "of the run"]  # fmt: skip


def _log_end(recording: Recording) -> None:
    outcome = recording.outcome
    _log.info("%s at %g s, after %.3g s", outcome.kind.value, outcome.time, recording.wall_seconds)
    for line in filter(None, (outcome.message, *recording.notes)):
        _log.info(line)


def _unstable(recording: Recording) -> bool:
    """True if a run diverged, or its coupling was seen to add energy without end."""
    energy = recording.energy
    return recording.outcome.unstable or (energy is not None and energy.verdict is Verdict.UNSTABLE)

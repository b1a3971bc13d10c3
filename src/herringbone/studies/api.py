"""Sweeps: a system at many operating points."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from pathlib import Path

from herringbone.analysis.anatomy import anatomy, check_numbers, orders_told
from herringbone.analysis.set_points import SPEED, TORQUE, addressed
from herringbone.components.registry import component
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import Role
from herringbone.core.given import (
    check_called,
    check_mapping,
    check_reference,
    check_several,
    is_number,
)
from herringbone.core.places.files import as_texts, is_file
from herringbone.core.process.telling import Tell, untold
from herringbone.core.wording import speaks_commands
from herringbone.cosim.structure.system import System
from herringbone.running.fitted import with_files
from herringbone.running.loading import load_scene, system_and_folder, with_options
from herringbone.running.operating.asked_tolerance import tolerance_notes
from herringbone.running.operating.commanded import commanded, own_point, with_known_values
from herringbone.running.operating.lean import changed_by
from herringbone.running.output.settings import key_of
from herringbone.running.pairs.gears import Gear
from herringbone.running.prepared import Named, Wishes
from herringbone.studies.axes import numbers
from herringbone.studies.computing import Progress, points_told
from herringbone.studies.evaluators.asked_columns import check_columns
from herringbone.studies.evaluators.evaluator import Base, Evaluator
from herringbone.studies.evaluators.settled import Settled
from herringbone.studies.evaluators.steady import Steady
from herringbone.studies.evaluators.transient import Transient
from herringbone.studies.keys import base_settings
from herringbone.studies.leaner import leaner_notes
from herringbone.studies.one_way import one_way_notes
from herringbone.studies.study import SET_POINTS, Study, Value, grid
from herringbone.studies.sweep import Asked, Sweep, computed
from herringbone.studies.working.executors import Workers


def sweep(
    system: str | Path | System,
    *,
    speed: Sequence[float] = (),
    torque: Sequence[float] = (),
    vary: Mapping[str, Sequence[Value]] | None = None,
    study: Study | None = None,
    scene: str | Path | None = None,
    values: Mapping[str, float | str | Path] | None = None,
    gear: Gear | Mapping[str, Gear] | None = None,
    housing: Named | None = None,
    replace_parts: Mapping[str, str | Path] | None = None,
    t_end: float | None = None,
    record_step: float | None = None,
    start: str | None = None,
    evaluator: Evaluator | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
    series: bool = False,
    parquet: bool = False,
    output: str | Path | None = None,
    overwrite: bool = False,
    told: Tell = untold,
    progress: bool | Progress = False,
) -> Sweep:
    """Evaluate a system at many operating points; see `docs/sweeps.md`.

    Args:
        system: name of a shipped system, folder with system.toml, .ssp file, or a System.
        speed: values of the speed set point that the system declares [rad/s].
        torque: of the torque set point [N m].
        vary: values by `instance.variable`, in SI units; all combinations are computed.
        study: points, in place of `speed`, `torque` and `vary`.
        scene, values, gear, housing, replace_parts, t_end, record_step, start: of all points, as in
            `herringbone.run`.
        evaluator: what computes a point; periodic steady states (`Steady`) if not given; with
            foreign parts what a run settles to (`Settled`), or with t_end such a run (`Transient`).
        executor: any of `concurrent.futures`, or such as that of `dask.distributed`; processes of
            our own if not given.
        workers: number of these; as many as there are cores, and as are worth it, if not given.
        series: keep rows over time of each point; needs `output`.
        parquet: write the table as Parquet as well.
        output: folder; what it has of the study is not computed again. None: nothing is kept.
        overwrite: the table of another study in the folder may be replaced.
        told: called with lines on what is ahead, on gears and housings, on what is not known of a
            leaner model, and on how wrong housings are that are driven one way.
        progress: True for a bar; or called with the number of points that were done since.

    Returns:
        The table, in memory. A point that failed is a row with its outcome.

    Raises:
        HerringboneError: something about the input is wrong.
    """
    if not isinstance(system, System):
        taken = "a name, a folder with system.toml, an .ssp file, or a System"
        check_reference("system", system, taken)
    check_mapping("values", values, '{"PART.VARIABLE": 1e-4}')
    check_mapping("vary", vary, '{"PART.VARIABLE": [1e-4, 2e-4]}')
    for name, several in {SPEED: speed, TORQUE: torque, **(vary or {})}.items():
        check_several(name, several)
    check_called("progress", progress)
    if study is None:
        axes = {SPEED: numbers(SPEED, speed), TORQUE: numbers(TORQUE, torque)}
        study = grid({**{n: v for n, v in axes.items() if v}, **(vary or {})})
    elif len(speed) or len(torque) or vary:
        raise ParameterError("study: it has its points; give no speed, torque or vary besides")
    if series and output is None:
        raise ParameterError("series: rows over time are kept in a folder; give output")
    wishes = Wishes(t_end, record_step, start, as_texts(values), gear, housing, replace_parts or {})
    named = str(scene) if scene is not None else None
    base = Base(_found(system), named, wishes, str(Path.cwd()))
    structure, folder = system_and_folder(base.system)
    chosen_scene = load_scene(folder, named)
    known = with_known_values(structure, chosen_scene, wishes)
    chosen = evaluator or _suited(known, wishes)
    said: tuple[str, ...] = ()
    if isinstance(chosen, Steady):
        said = tolerance_notes(chosen_scene, chosen.tolerance)
        chosen = chosen.as_fine_as_asked(chosen_scene)
    check_columns(known, chosen.columns)
    _check_wishes(wishes, chosen, series=series)
    _check_once(known, study.names, wishes.values)
    units = {name: _unit(known, name) for name in study.names}
    _check_texts(known, study)
    units |= {SPEED: study.speed_unit} if SPEED in units else {}
    first = study.point(0)
    commanded(known.with_values({n: v for n, v in first.items() if n not in SET_POINTS}), first)
    own = with_options(chosen_scene, values=wishes.values)
    files = with_files(structure, own, wishes, folder)
    leaner = leaner_notes(chosen_scene.model, study, changed_by(wishes), own_point(known))
    one_way = one_way_notes(known, study, base)
    for line in (*files.notes, *files.of_fmus, *said, *leaner, *one_way):
        told(line)
    settings = base_settings(base, chosen)
    asked = Asked(
        key_of(settings),
        settings,
        units,
        structure.name,
        None if output is None else Path(output).absolute(),
        series,
        parquet,
        overwrite,
        _told_pairs(known),
    )
    cells = len(known.foreign_parts)
    with points_told(progress, len(study.points)) as shown:
        return computed(
            study, base, chosen, asked, Workers(executor, workers, 1 + cells), told, shown
        )


def _suited(system: System, wishes: Wishes) -> Evaluator:
    """Steady states, of runs where parts are foreign; these runs as long as asked for, if so."""
    if system.foreign_parts:
        return Settled() if wishes.t_end is None else Transient()
    return Steady()


def _check_wishes(wishes: Wishes, evaluator: Evaluator, *, series: bool) -> None:
    """Raise ParameterError for what only runs have, where points are not evaluated by runs."""
    of_runs = {"t_end": wishes.t_end, "record_step": wishes.record_step, "start": wishes.start}
    given = [name for name, value in of_runs.items() if value is not None]
    if series:
        given.append("series")
    if given and not evaluator.has_series:
        raise _of_runs(", ".join(given))


def _of_runs(what: str) -> ParameterError:
    by = "--transient" if speaks_commands() else "evaluator=hb.Transient()"
    return ParameterError(
        f"{what}: of runs, and steady states are without; evaluate the points by runs ({by})"
    )


def _told_pairs(system: System) -> str:
    """Of which gear pair mesh orders are, and of which groups; "" of a system with one."""
    orders = orders_told(system)
    pairs = anatomy(system).with_role(Role.GEAR_PAIR)
    return f"{orders}, groups of channels over {' and '.join(pairs)}" if orders else ""


def _found(system: str | Path | System) -> str | System:
    """A system as processes in other folders find it."""
    if isinstance(system, System):
        return system
    there = Path(system)
    return str(there.absolute()) if there.is_dir() or is_file(there) else str(system)


def _check_once(known: System, names: Sequence[str], fixed: Mapping[str, object]) -> None:
    """Raise ParameterError if a variable is varied under two names, or varied and set besides."""
    seen: dict[object, str] = {}
    for name in (*names, *fixed):
        if name in SET_POINTS or name.rpartition(".")[0] in known.sensors:
            continue
        first = seen.setdefault(known.split(name), name)
        if first != name:
            raise ParameterError(f"{first} and {name} are the same variable; give one of them")
    if twice := sorted(set(names) & set(fixed)):
        raise ParameterError(f"{twice[0]} is varied, and set besides; give one of them")


def _check_texts(known: System, study: Study) -> None:
    """Raise ParameterError if a text is given where a number is due; the rest points tell."""
    for name, values in zip(study.names, zip(*study.points, strict=True), strict=True):
        for text in dict.fromkeys(value for value in values if not is_number(value)):
            check_numbers(known.with_values({name: text}))


def _unit(system: System, name: str) -> str:
    """Unit of a parameter; raises HerringboneError if there is none of that name."""
    if name in SET_POINTS:
        addressed(system, name)
        return SET_POINTS[name]
    part, variable = system.split(name)
    declared = system.part(part).component
    if declared is None:
        return ""
    declaration = component(declared).declaration
    if any(text.name == variable for text in declaration.texts):
        return ""
    return declaration.variable(variable).unit

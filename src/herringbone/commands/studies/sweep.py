"""The command `sweep`: a system at many operating points, from its options to the table."""

import argparse
import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from herringbone.commands.options import (
    add_cells,
    add_replacements,
    add_scene,
    add_sensitivities,
    add_solver,
    add_start_values,
    assignments,
    files_of_parts,
    refuse_given,
    replacements,
    spread_of,
    start_values,
)
from herringbone.commands.output import check_writable, say, show
from herringbone.core import ParameterError
from herringbone.result.folder.names import remove_study_pictures

if TYPE_CHECKING:
    from herringbone.running.prepared import Wishes
    from herringbone.studies.evaluators.evaluator import Evaluator
    from herringbone.studies.sweep import Sweep

_AXES = "START:STOP:COUNT or A,B,..."
_GOOD = {"completed", "steady", "ended_by_part"}
_SET = "INSTANCE.VARIABLE=VALUES"


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the command's options."""
    add_scene(sub)
    sub.add_argument(
        "--speed", metavar="VALUES", help=f"speed set point in r/min: {_AXES}, ends included"
    )
    sub.add_argument("--torque", metavar="VALUES", help=f"torque set point in N m: {_AXES}")
    sub.add_argument(
        "--study", type=Path, metavar="FILE",
        help="grid, points or sample (TOML) in place of these; see 'herringbone template study'",
    )  # fmt: skip
    add_start_values(sub, varied=f"{_AXES} is varied; ")
    sub.add_argument(
        "--transient", action="store_true",
        help="points by runs of the same duration; steady states if not given, with foreign parts "
        "what a run settles to",
    )  # fmt: skip
    sub.add_argument("--t-end", type=float, help="duration of each run in s")
    sub.add_argument("--record-step", type=float, help="time between records in s")
    sub.add_argument("--start", help="equilibrium, ramp or rest; the scene's if not given")
    sub.add_argument("--step", type=float, help="step size in s, of the coupling or the core")
    sub.add_argument(
        "--tolerance", type=float,
        help="relative error of each point; 0.001, or less if the scene asks steady states for it, "
        "if not given",
    )  # fmt: skip
    sub.add_argument("--algorithm", help="run coupled with this algorithm, not fused")
    add_replacements(sub)
    add_cells(sub)
    sub.add_argument(
        "--column", action="append", default=[], metavar="OUTPUTS",
        help="output, pattern, or group for each of its outputs, with levels of its own, besides "
        "the groups; may be repeated",
    )  # fmt: skip
    add_sensitivities(sub)
    add_solver(sub)
    sub.add_argument("--workers", type=int, help="processes; as many as are worth it if not given")
    sub.add_argument("--series", action="store_true", help="keep rows over time of each point")
    sub.add_argument("--parquet", action="store_true", help="also write table.parquet")
    sub.add_argument(
        "-o", "--output", type=Path,
        help="folder; results/sweep-SYSTEM if not given. What it has of the study is kept",
    )  # fmt: skip
    sub.add_argument(
        "--overwrite", action="store_true", help="replace the table of another study in the folder"
    )
    sub.add_argument("--json", action="store_true", help="print one JSON object")


def run(options: argparse.Namespace) -> int:
    """Compute what is missing, write the table, and say what came out.

    The exit code is 1 if a point came to nothing.

    Raises:
        HerringboneError: something about the input is wrong, or files cannot be written.
    """
    from tqdm import tqdm  # noqa: PLC0415 (only when something runs)

    from herringbone.running.prepared import Wishes  # noqa: PLC0415
    from herringbone.studies.api import sweep  # noqa: PLC0415 (numba: only when something runs)
    from herringbone.studies.study import PER_MINUTE, grid  # noqa: PLC0415
    from herringbone.studies.study_file import read_study_file  # noqa: PLC0415

    folder = options.output or Path("results") / f"sweep-{Path(options.system).stem}"
    check_writable(folder)
    spread = spread_of(options)
    fixed, points = _points(options)
    files = files_of_parts(options)
    if options.study is None:
        study = replace(grid(points), speed_unit=PER_MINUTE)
    elif points:
        raise ParameterError(f"--study has its points; drop {', '.join(points)}")
    else:
        study = read_study_file(options.study)
    replaced = replacements(options)
    evaluator = _evaluator(options, Wishes(housing=files["housing"], replace_parts=replaced))
    tqdm.monitor_interval = 0  # a thread, and what has threads is not forked
    with tqdm(total=len(study.points), unit=" points", disable=None) as bar:
        found = sweep(
            options.system,
            study=study,
            scene=options.scene,
            values=fixed,
            **files,
            replace_parts=replaced,
            t_end=options.t_end,
            record_step=options.record_step,
            start=options.start,
            evaluator=evaluator,
            workers=options.workers,
            series=options.series,
            parquet=options.parquet,
            output=folder,
            overwrite=options.overwrite,
            told=say,
            progress=bar.update,
        )
    from herringbone.plotting.studies.pictures import write_study_pictures  # noqa: PLC0415

    title = ": ".join(filter(None, (Path(options.system).stem, found.of)))
    drawn = write_study_pictures(found.table, found.units, folder, title, spread)
    remove_study_pictures(folder, but=drawn.files)
    for line in drawn.missing:
        say(line)
    files_told = [str(folder / file.name) for file in (*found.files, *drawn.files)]
    show(_summary(found, files_told, as_json=options.json))
    return int(not set(found.table["outcome"]) <= _GOOD)


def _points(options: argparse.Namespace) -> tuple[dict[str, Any], dict[str, Any]]:
    """Values that all points have, and those that are varied."""
    from herringbone.studies.axes import axis  # noqa: PLC0415

    fixed, varied = [], {}
    for item in options.set:
        ((name, text),) = assignments([item], "--set", _SET).items()
        if len(found := axis(name, text)) > 1:
            varied[name] = found
        else:
            fixed.append(item)
    points: dict[str, Any] = {
        name: axis(name, text)
        for name in ("speed", "torque")
        if (text := getattr(options, name)) is not None
    }
    points |= varied
    return start_values(fixed), points


def _evaluator(options: argparse.Namespace, wishes: "Wishes") -> "Evaluator | None":
    """What was asked for; None: chosen by the system.

    Raises:
        ParameterError: something is asked of runs, and not the runs.
    """
    from herringbone.running.operating.steady import is_foreign  # noqa: PLC0415
    from herringbone.studies.evaluators.settled import Settled  # noqa: PLC0415
    from herringbone.studies.evaluators.steady import Steady  # noqa: PLC0415
    from herringbone.studies.evaluators.transient import Transient  # noqa: PLC0415

    columns = tuple(options.column)
    of_runs = {n: v for n in ("step", "algorithm") if (v := getattr(options, n)) is not None}
    tolerance = {} if options.tolerance is None else {"tolerance": options.tolerance}
    asked = options.sensitivities
    by = {} if options.solver is None else {"solver": options.solver}
    if options.transient:
        _refuse_of_states(options)
        return Transient(columns=columns, **of_runs, **tolerance)
    if not (of_runs or columns or tolerance or by or asked is not None):
        return None
    if is_foreign(options.system, options.scene, wishes):
        _refuse_of_states(options)
        if options.t_end is not None:
            return Transient(columns=columns, **of_runs, **tolerance)
        return Settled(columns=columns, **of_runs, **tolerance)
    if of_runs:
        raise ParameterError(f"--{next(iter(of_runs))}: of runs; add --transient")
    sensitivities = None if asked is None else tuple(asked)
    return Steady(columns=columns, sensitivities=sensitivities, **tolerance, **by)


def _refuse_of_states(options: argparse.Namespace) -> None:
    """Refuse what is of steady states alone; raises ParameterError."""
    why = "of steady states whose equations are all known"
    refuse_given(options, ("solver",), why)
    if options.sensitivities is not None:  # without names: of all dampings
        raise ParameterError(f"--sensitivities: {why}")


def _summary(found: "Sweep", files: list[str], *, as_json: bool) -> str:
    from herringbone.plotting.studies.largest import (  # noqa: PLC0415 (matplotlib)
        largest_levels,
        largest_text,
    )
    from herringbone.plotting.studies.table import Points  # noqa: PLC0415

    outcomes = found.table["outcome"].value_counts().to_dict()
    points = Points(found.table, found.units)
    if as_json:
        largest = {
            own.group: {own.kind: own.level, "unit": found.units[own.column], "at": own.at}
            for own in largest_levels(points)
        }
        return json.dumps(
            {
                "points": len(found.table),
                "outcomes": outcomes,
                "largest": largest,
                "of": found.of or None,
                "results": files,
            }
        )
    told = ", ".join(f"{count} {kind}" for kind, count in outcomes.items())
    lines = [f"{len(found.table)} points: {told}", *filter(None, [found.of])]
    bad = found.table[~found.table["outcome"].isin(_GOOD)]
    for row in bad.head(3).itertuples(index=False):
        lines.append(f"point {row.point}: {row.outcome}: {row.message}")
    if len(bad) > 3:
        lines.append(f"... and {len(bad) - 3} more; see the table")
    return "\n".join([*lines, *largest_text(points), "Files: " + ", ".join(files)])

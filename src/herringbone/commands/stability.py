"""The command `stability`: what is known of the coupling before a run."""

import argparse
import json
from collections.abc import Sequence
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from herringbone.commands.answers import Told, answered
from herringbone.commands.checking import flange
from herringbone.commands.options import (
    add_cells,
    add_comparison,
    add_replacements,
    add_start_values,
    given_by,
    operating_point,
    replacements,
)
from herringbone.commands.output import check_writable, say, show, written_into
from herringbone.core import ParameterError
from herringbone.core.places.files import write_whole
from herringbone.core.process.telling import Tell
from herringbone.running.operating.one_step import check_asked

if TYPE_CHECKING:
    from herringbone.analysis.stability.atlas import Panel
    from herringbone.cosim.algorithms import Algorithm
    from herringbone.running.foreign.predictable import Predictable


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the command's own options."""
    add_comparison(sub)
    sub.add_argument("--step", type=float, help="only say what happens at this step in s, and why")
    sub.add_argument(
        "--tolerance", type=float, default=1e-3,
        help="relative error asked for; %(default)g if not given",
    )  # fmt: skip
    sub.add_argument(
        "--simulate", action="store_true", help="also find the non-linear system's limits by runs"
    )
    sub.add_argument(
        "--atlas", action="store_true", help="also draw limits, by runs too; two minutes"
    )
    sub.add_argument("-o", "--output", type=Path, help="folder for the files")
    flange.add_options(sub)
    sub.add_argument("--json", action="store_true", help="print one JSON object")
    add_replacements(sub)
    add_cells(sub)
    add_start_values(sub)


def run(options: argparse.Namespace) -> int:
    """Predict, write files if a folder is given, and show what is known.

    Raises:
        HerringboneError: something about the input is wrong.
    """
    show(_answer(options))
    return 0


def _answer(options: argparse.Namespace) -> str:
    """What to show; files are written."""
    if flange.is_asked(options):
        told = answered(options, lambda tell: flange.flange_limits(options))
        return json.dumps(told.summary) if options.json else told.text
    _check(options)
    output = options.output or (Path("results") if options.atlas else None)
    if output:
        check_writable(output)
    panels: list[Panel] = []
    find = partial(_predicted, options, panels)
    told = find(say) if options.atlas else answered(options, find)
    if options.step is not None:
        return json.dumps(told.summary) if options.json else told.text
    files = _written(told, output) if output else []
    if output and panels:
        from herringbone.plotting.stability_atlas import write_atlas  # noqa: PLC0415

        files.append(output / "stability_atlas.png")
        write_atlas(panels, files[-1])
    if options.json:
        return json.dumps({**told.summary, "results": [str(f) for f in files]})
    written = ["", "Files: " + ", ".join(str(f) for f in files)] if files else []
    return "\n".join([told.text, *written])


def _predicted(options: argparse.Namespace, panels: list["Panel"], tell: Tell) -> Told:
    """What is predicted, of one step or of all; the panels of an atlas are added."""
    from herringbone.running.operating.stability import fixed_steps, known_before  # noqa: PLC0415
    from herringbone.running.prepared import Wishes  # noqa: PLC0415 (numba)
    from herringbone.running.reporting.progress import counted  # noqa: PLC0415

    algorithms = fixed_steps(options.algorithm or ())
    wishes = Wishes(**given_by(options), replace_parts=replacements(options))
    at = operating_point(options)
    known = known_before(options.system, options.scene, at["speed"], at["torque"], wishes, tell)
    with known as found, counted(None, "matrices") as show:
        if options.step is not None:
            return _of_step(found, algorithms, options.step, show)
        return _of_all_steps(found, algorithms, options, panels, show)


def _of_step(of: "Predictable", algorithms: Sequence["Algorithm"], step: float, show: Tell) -> Told:
    """What happens at one step [s], by algorithm."""
    from herringbone.running.operating.stability import verdicts_before  # noqa: PLC0415

    found = verdicts_before(of, algorithms, step, show)
    return Told(str(found), [{**asdict(v), "stable": v.stable} for v in found])


def _of_all_steps(
    of: "Predictable",
    algorithms: Sequence["Algorithm"],
    options: argparse.Namespace,
    panels: list["Panel"],
    show: Tell,
) -> Told:
    """Stable steps, bonds and a recommendation; see `_predicted`."""
    from herringbone.analysis.stability import report  # noqa: PLC0415
    from herringbone.analysis.stability.atlas import atlas, unscaled  # noqa: PLC0415
    from herringbone.running.operating.stability import stability_before  # noqa: PLC0415

    if of.strangers and options.atlas:
        raise ParameterError("--atlas takes no foreign FMUs; leave it out")
    found = stability_before(of, algorithms, options.tolerance, options.simulate, show)
    if options.atlas:
        panels += atlas(of.system, progress=show)
        found = replace(found, notes=(*found.notes, *unscaled(of.system)))
    return Told(report.stability_text(found), report.stability_summary(found))


def _check(options: argparse.Namespace) -> None:
    check_asked(options.step, simulate=options.simulate)
    for name in ("atlas", "output"):
        if options.step is not None and getattr(options, name):
            raise ParameterError(f"--step asks about one step; leave --{name} out")


def _written(told: Told, folder: Path) -> list[Path]:
    """The files stability.txt and stability.json, written to a folder, made if needed.

    Raises:
        HerringboneError: a file cannot be written.
    """
    contents = {
        folder / "stability.txt": told.text,
        folder / "stability.json": json.dumps(told.summary),
    }
    with written_into(folder):
        for file, content in contents.items():
            write_whole(file, content + "\n")
    return list(contents)

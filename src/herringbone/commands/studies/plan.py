"""The command `plan`: how much model, and which solver, a scene's questions need."""

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

from herringbone.commands.options import (
    add_scene,
    add_start_values,
    given_by,
)
from herringbone.commands.output import check_writable, show
from herringbone.core import HerringboneError, ParameterError
from herringbone.core.errors import reason

if TYPE_CHECKING:
    from herringbone.studies.planning.plan import Plan


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the command's options."""
    add_scene(sub)
    add_start_values(sub)
    sub.add_argument(
        "-o", "--output", type=Path, help="folder for plan.json, and scene.toml with the choice"
    )
    sub.add_argument(
        "--chart", action="store_true",
        help="with -o: draw error against cost over joint choices of model and solver",
    )  # fmt: skip
    sub.add_argument("--json", action="store_true", help="print one JSON object")


def run(options: argparse.Namespace) -> int:
    """Plan, write files if a folder is given, and show.

    Raises:
        HerringboneError: something about the input is wrong.
    """
    from herringbone.studies.planning.plan import plan  # noqa: PLC0415 (numba)
    from herringbone.studies.planning.text import (  # noqa: PLC0415
        estimates_text,
        plan_summary,
        plan_text,
        write_plan,
    )

    if options.chart and not options.output:
        raise ParameterError("--chart: in which folder? add -o FOLDER")
    if options.output:
        check_writable(options.output)
    found = plan(
        options.system,
        scene=options.scene,
        **given_by(options),
        chart=options.chart,
        estimated=None if options.json else lambda rungs: show("\n".join(estimates_text(rungs))),
    )
    written = write_plan(found, options.output) if options.output else []
    if found.joint:
        written.append(_drawn(found, options.output))
    if options.json:
        show(json.dumps({**plan_summary(found), "results": [str(f) for f in written]}))
    else:
        show("\n".join([*plan_text(found), *(f"Files: {f}" for f in written)]))
    return 0


def _drawn(found: "Plan", folder: Path) -> Path:
    """The file of the chart."""
    from herringbone.plotting.studies.plan_chart import plan_chart  # noqa: PLC0415 (matplotlib)

    file = folder / "plan.png"
    try:
        plan_chart(found).savefig(file)
    except OSError as error:
        raise HerringboneError(f"cannot write {file}: {reason(error)}") from error
    return file

"""The command `steady`: the periodic steady state of a system at an operating point."""

import argparse
import json
from pathlib import Path

from herringbone.commands.options import (
    add_cells,
    add_replacements,
    add_scene,
    add_start_values,
    files_of_parts,
    replacements,
    start_values,
)
from herringbone.commands.output import check_writable, say, show


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the command's options."""
    add_scene(sub)
    sub.add_argument("--speed", type=float, help="of the pinion in r/min; the scene's if not given")
    sub.add_argument("--torque", type=float, help="at the pinion in N m; the scene's if not given")
    sub.add_argument("--tolerance", type=float, default=1e-3, help="relative error, 1e-3")
    add_start_values(sub)
    add_replacements(sub)
    add_cells(sub)
    sub.add_argument(
        "--longest", type=float, default=10.0, metavar="SECONDS",
        help="with foreign parts, which are run until they settle: duration at most, 10 s",
    )  # fmt: skip
    sub.add_argument("-o", "--output", type=Path, help="folder for orders.csv and steady.json")
    sub.add_argument("--json", action="store_true", help="print one JSON object")


def run(options: argparse.Namespace) -> int:
    """Solve, write files if a folder is given, and show; exit code 1 if nothing steady was found.

    Raises:
        HerringboneError: something about the input is wrong.
    """
    from herringbone.analysis.steady.report import (  # noqa: PLC0415 (numba)
        per_second,
        steady_summary,
        steady_text,
        write_steady,
    )
    from herringbone.running.steady import steady  # noqa: PLC0415

    if options.output:
        check_writable(options.output)
    files = files_of_parts(options)
    state = steady(
        options.system,
        scene=options.scene,
        speed=None if options.speed is None else per_second(options.speed),
        torque=options.torque,
        values=start_values(options.set),
        gear=files.gear,
        housing=files.housing,
        replace_parts=replacements(options),
        tolerance=options.tolerance,
        longest=options.longest,
    )
    for note in state.notes:
        say(note)
    written = write_steady(state, options.output) if options.output else []
    if options.json:
        show(json.dumps({**steady_summary(state), "results": [str(f) for f in written]}))
    else:
        show("\n".join([*steady_text(state), *(f"Files: {f}" for f in written)]))
    return 0 if state.converged else 1

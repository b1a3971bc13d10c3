"""The command `chart`: its options, and what it shows."""

import argparse
from pathlib import Path

from herringbone.commands.options import (
    add_cells,
    add_comparison,
    add_kind,
    add_replacements,
    add_start_values,
    given_by,
    operating_point,
    replacements,
)
from herringbone.commands.output import check_writable, show
from herringbone.core import EXIT_CODES


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the command's options."""
    add_comparison(sub)
    sub.add_argument(
        "--steps",
        type=float,
        nargs="+",
        help="communication step sizes in s; a ladder of them if not given",
    )
    sub.add_argument(
        "--tolerances",
        type=float,
        nargs="+",
        help="relative errors: a curve of adaptive li; none if not given",
    )
    sub.add_argument("--fuse", action="store_true", help="curves of the fused system, too")
    sub.add_argument(
        "--t-end", type=float, help="duration of each run in s; the scene's if not given"
    )
    add_kind(sub)
    add_replacements(sub)
    add_cells(sub)
    add_start_values(sub)
    sub.add_argument(
        "-o", "--output", type=Path, help="folder; results/chart-SYSTEM-SCENE if not given"
    )
    sub.add_argument("--json", action="store_true", help="print one JSON object")


def run(options: argparse.Namespace) -> int:
    """Measure, write the files, and show what came out; returns the exit code.

    Raises:
        HerringboneError: something about the input is wrong, or files cannot be written.
    """
    from herringbone.commands.chart.report import charted  # noqa: PLC0415 (numba)

    check_writable(options.output or Path("results"))
    given = {"algorithms": options.algorithm, **vars(options)}
    given = {name: given[name] for name in ("algorithms", "steps", "tolerances", "t_end")}
    text, outcome = charted(
        options.system,
        options.output,
        as_json=options.json,
        scene=options.scene,
        fmu=options.fmu,
        fuse=options.fuse,
        **operating_point(options),
        **given_by(options),
        replace_parts=replacements(options),
        **{name: value for name, value in given.items() if value is not None},
    )
    show(text)
    return EXIT_CODES[outcome]

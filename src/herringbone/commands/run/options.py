"""Options of the command `run`."""

import argparse
from pathlib import Path

from herringbone.commands.options import (
    add_cells,
    add_kind,
    add_operating_point,
    add_replacements,
    add_scene,
    add_start_values,
)

SLOW = "INSTANCE=N,..."
"""How bodies that step less often are given."""


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the command's options."""
    add_scene(sub, optional=True)
    add_operating_point(sub)
    _add_coupling(sub)
    sub.add_argument("--t-end", type=float, help="duration in s; the scene's if not given")
    sub.add_argument("--record-step", type=float, help="time between records in s")
    sub.add_argument("--start", help="equilibrium, ramp or rest; the scene's if not given")
    add_kind(sub)
    add_replacements(sub)
    add_cells(sub)
    add_start_values(sub)
    sub.add_argument(
        "--no-probe", action="store_true",
        help="take foreign FMUs by what they declare, without trial steps on further instances",
    )  # fmt: skip
    _add_models(sub)
    _add_errors(sub)
    _add_results(sub)


def given_options(options: argparse.Namespace) -> list[str]:
    """Names of the command's options whose values are other than their defaults."""
    parser = argparse.ArgumentParser()
    add_options(parser)
    defaults = vars(parser.parse_args([]))
    return [name for name, default in defaults.items() if getattr(options, name) != default]


def _add_coupling(sub: argparse.ArgumentParser) -> None:
    """How parts are coupled, and in which steps."""
    sub.add_argument(
        "--algorithm", help="NAME or NAME:key=value,..., e.g. li:degree=3; auto if not given"
    )
    sub.add_argument(
        "--step", type=float, help="communication step size in s; the largest, with --tolerance"
    )
    sub.add_argument(
        "--tolerance",
        type=float,
        help="relative error: li adapts its step; with foreign FMUs it is found by runs; 1e-3 for "
        "gear pairs of this package if no algorithm, step or slow body is given",
    )
    sub.add_argument(
        "--slow", metavar=SLOW, help="heavy bodies that step once in N communication steps"
    )


def _add_models(sub: argparse.ArgumentParser) -> None:
    """What stands for the parts: one core of them, or a leaner model."""
    sub.add_argument(
        "--fuse", action="store_true",
        help="condense all own parts into one core, marched by steps that --tolerance chooses, or "
        "coupled with foreign FMUs",
    )  # fmt: skip
    sub.add_argument(
        "--record", action="append", default=[], metavar="OUTPUTS",
        help="with --fuse: group of channels or pattern of outputs to record; all if none is given",
    )  # fmt: skip
    sub.add_argument(
        "--plan", action="store_true",
        help="find the least model and the solver that answer what the scene asks, and run these",
    )  # fmt: skip


def _add_errors(sub: argparse.ArgumentParser) -> None:
    """What the run's errors are measured against."""
    memory = "memory grows with the duration"
    sub.add_argument(
        "--reference", action="store_true", help=f"errors against the monolithic twin; {memory}"
    )
    sub.add_argument(
        "--verify", action="store_true", help=f"errors against a run with half the step; {memory}"
    )


def _add_results(sub: argparse.ArgumentParser) -> None:
    """Where results go, and what is written or printed of them."""
    sub.add_argument("--parquet", action="store_true", help="also write results.parquet")
    sub.add_argument(
        "--no-pictures", action="store_true",
        help="draw none, which takes longer than a short run; 'herringbone plot' draws them later",
    )  # fmt: skip
    sub.add_argument(
        "-o", "--output", type=Path,
        help="folder; results/SYSTEM-SCENE if not given, with a number if that holds another run",
    )  # fmt: skip
    sub.add_argument(
        "--overwrite", action="store_true", help="overwrite results of other settings in the folder"
    )
    sub.add_argument(
        "--resume", type=Path, metavar="FOLDER", help="go on with a run that was cut off"
    )
    sub.add_argument("--json", action="store_true", help="print one JSON object")

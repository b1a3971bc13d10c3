"""The command `plot`: pictures of a run or of a study that is in a folder."""

import argparse
from pathlib import Path

from herringbone.commands.output import check_writable, say, show, written_into
from herringbone.core import ParameterError
from herringbone.core.frequencies import HIGHEST, check_end
from herringbone.core.places.files import is_file
from herringbone.result.folder.names import STUDY, STUDY_TABLE


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the command's options."""
    sub.add_argument("folder", type=Path, help="folder of a run or of a sweep")
    sub.add_argument(
        "--highest",
        type=float,
        help=f"end of spectra and waterfalls in Hz; {HIGHEST:g} if not given",
    )
    sub.add_argument(
        "--columns", nargs="+", default=[], metavar="PATTERN",
        help="columns (*, ?) over time, and of a run-up their orders, in place of all pictures",
    )  # fmt: skip
    sub.add_argument("-o", "--output", type=Path, help="folder for the pictures; FOLDER itself")


def run(options: argparse.Namespace) -> int:
    """Draw, and tell the files.

    Raises:
        HerringboneError: the folder holds no results, or files cannot be written.
    """
    output = options.output or options.folder
    if options.highest is not None:
        check_end("highest", options.highest, finite=False)
    if not options.folder.exists():
        raise ParameterError(f"there is no folder {options.folder}")
    if is_file(options.folder):
        raise ParameterError(f"{options.folder} is a file: plot takes the folder that it is in")
    study = any(is_file(options.folder / name) for name in (STUDY, STUDY_TABLE))
    if study and (options.columns or options.highest):
        raise ParameterError("--columns and --highest are of runs; this is the folder of a sweep")
    check_writable(output)
    with written_into(output):
        files = _study(options.folder, output) if study else _run(options, output)
    show("Files: " + (", ".join(map(str, files)) or "none: there is nothing to draw"))
    return 0


def _run(options: argparse.Namespace, output: Path) -> list[Path]:
    from herringbone.analysis.figures.runup import speed_changes  # noqa: PLC0415
    from herringbone.plotting import plot_columns, write_pictures  # noqa: PLC0415 (lazy)
    from herringbone.plotting.runs.runup import run_up  # noqa: PLC0415
    from herringbone.result.folder.load import load  # noqa: PLC0415

    result = load(options.folder)
    if not options.columns:
        return write_pictures(result, output, options.highest)
    figures = {"columns": plot_columns(result, *options.columns)}
    if speed_changes(result):
        figures["run_up"] = run_up(result, *options.columns, highest=options.highest)
    files = [output / f"{name}.png" for name in figures]
    for file, figure in zip(files, figures.values(), strict=True):
        figure.savefig(file)
    return files


def _study(folder: Path, output: Path) -> list[Path]:
    from herringbone.plotting.studies.pictures import write_study_pictures  # noqa: PLC0415 (lazy)
    from herringbone.studies.table import read_table  # noqa: PLC0415

    found = read_table(folder)
    drawn = write_study_pictures(found.data, found.units, output, folder.name)
    for line in drawn.missing:
        say(line)
    return drawn.files

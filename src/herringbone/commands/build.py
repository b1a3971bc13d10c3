"""The command `build`: FMUs of components, Python or native."""

import argparse
from pathlib import Path

from herringbone.commands.options import assignments
from herringbone.commands.output import check_writable, show

_SET = "COMPONENT.PARAMETER=FILE"


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the command's options."""
    sub.add_argument("component", nargs="*", help="components; all if none is given")
    sub.add_argument("--native", action="store_true", help="without Python at run time")
    add_platform_options(sub)
    sub.add_argument(
        "--set",
        action="append",
        default=[],
        metavar=_SET,
        help="resource file that a native FMU carries instead of its own; may be repeated",
    )
    sub.add_argument(
        "-o",
        "--output",
        type=Path,
        help="folder to copy the FMUs to, as COMPONENT.fmu, with --fmi 3 as COMPONENT_fmi3.fmu; "
        "files of these names are replaced",
    )


def add_platform_options(sub: argparse.ArgumentParser) -> None:
    """Declare the options of native FMUs."""
    sub.add_argument("--fmi", type=int, default=2, help="FMI version of native FMUs, 2 or 3")
    sub.add_argument(
        "--platforms",
        nargs="+",
        default=[],
        metavar="PLATFORM",
        help="platforms of native FMUs, such as x86_64-windows, or all; this one if not given",
    )


def run(options: argparse.Namespace) -> int:
    """Build, and show the files and what is to be known of them.

    Raises:
        HerringboneError: something about the options is wrong, or the build fails.
    """
    from herringbone.running.exporting.export import (  # noqa: PLC0415 (numba: only when it builds)
        build_fmus,
        chosen_platforms,
        untested,
    )

    if options.output:
        check_writable(options.output)
    platforms = chosen_platforms(options.platforms)
    files = assignments(options.set, "--set", _SET)
    fmus = build_fmus(
        options.component,
        options.output,
        native=options.native,
        platforms=platforms,
        fmi=options.fmi,
        files={path: Path(file) for path, file in files.items()},
    )
    for line in (*map(str, fmus), *untested(platforms)):
        show(line)
    return 0

"""`python -m herringbone.commands.release [FOLDER]`: all FMUs, checksums, a wheel with the FMUs.

For those who release the package, in a clone. FOLDER (build/release if not given) gets

    python/COMPONENT.fmu            Python FMUs, FMI 2.0
    fmi2/, fmi3/COMPONENT.fmu       native FMUs for all platforms
    fmi2/, fmi3/gearbox.fmu         the gearbox for hosts
    herringbone-VERSION-*.whl       the wheel, with the native FMUs of components
    SHA256SUMS                      of all of them, as `sha256sum --check` reads it

Platforms other than this one need zig (`pip install herringbone[native]`); `--platforms` leaves
some out.
"""

import argparse
import hashlib
import shutil
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from herringbone.commands.generate.items import clone
from herringbone.commands.output import logged, say, show
from herringbone.commands.release.wheel import build_wheel
from herringbone.core import HerringboneError
from herringbone.core.declaring.hosting import Wanted
from herringbone.core.places.paths import cache_root
from herringbone.fmi.native import PLATFORMS
from herringbone.fmi.native.build import VERSIONS
from herringbone.fmi.native.carried import IN_WHEEL, carried_name
from herringbone.running.exporting.export import build_fmus
from herringbone.running.exporting.system_fmu import export_fmu

SUMS = "SHA256SUMS"
_HOSTED = "gearbox"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; the exit code is 2 if something fails."""
    parser = argparse.ArgumentParser(
        prog="python -m herringbone.commands.release",
        description="Build all FMUs, a wheel that carries the native ones, and checksums.",
    )
    parser.add_argument("folder", nargs="?", type=Path, help="build/release if not given")
    parser.add_argument(
        "--platforms",
        nargs="+",
        default=list(PLATFORMS),
        metavar="PLATFORM",
        help="of native FMUs; all if not given",
    )
    options = parser.parse_args(arguments)
    folder = options.folder or cache_root() / "release"
    try:
        with logged():
            for file in release(folder, options.platforms):
                show(str(file))
    except HerringboneError as error:
        say(f"herringbone: {error}")
        return 2
    return 0


def release(folder: Path, platforms: Sequence[str]) -> Iterator[Path]:
    """Make a release in a folder, which is made anew; yields its files.

    Raises:
        HerringboneError: there is no such platform, or something cannot be built.
    """
    root = clone()
    shutil.rmtree(folder, ignore_errors=True)
    files, carried = build_fmus((), folder / "python"), {}
    for fmi in VERSIONS:
        built = build_fmus((), native=True, platforms=platforms, fmi=fmi)
        target = folder / f"fmi{fmi}"
        target.mkdir(parents=True)
        for file in built:
            files.append(Path(shutil.copyfile(file, target / file.name)))
            carried[f"{IN_WHEEL}/{carried_name(file.stem, fmi)}"] = file
        hosted = target / f"{_HOSTED}.fmu"
        wanted = Wanted()
        files.append(export_fmu(_HOSTED, hosted, platforms=platforms, fmi=fmi, wanted=wanted))
    files.append(build_wheel(root, folder, carried))
    yield from files
    yield write_sums(folder, files)


def write_sums(folder: Path, files: Sequence[Path]) -> Path:
    """Write the checksums of a folder's files."""
    names = sorted(file.relative_to(folder).as_posix() for file in files)
    sums = ((hashlib.sha256((folder / name).read_bytes()).hexdigest(), name) for name in names)
    target = folder / SUMS
    target.write_text("".join(f"{digest}  {name}\n" for digest, name in sums), encoding="utf-8")
    return target


if __name__ == "__main__":
    sys.exit(main())

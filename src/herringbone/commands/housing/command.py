"""`herringbone housing`: make, reduce, import a housing."""

import argparse
import json
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from herringbone.commands.options import add_command
from herringbone.commands.output import check_writable, say, show
from herringbone.core.reduction import BAND, TOLERANCE
from herringbone.core.wording import percent

if TYPE_CHECKING:
    from herringbone.housing.welded.build import BuiltHousing

_BAR = "stage {n} of {total} |{bar}| {elapsed} {desc}"
_LEAST_SHARE = 0.1
"""Smaller shares of a mode's energy are not shown."""


def register(commands: Any) -> None:  # noqa: ANN401 (argparse's type is private)
    """Add the command to those of the program."""
    text = "make, reduce and import housings"
    group = commands.add_parser("housing", help=text, description=text)
    commands = group.add_subparsers(required=True, metavar="COMMAND")
    add = partial(add_command, commands)
    sub = add("build", _build, "mesh and solve a welded housing, write its modal data")
    sub.add_argument(
        "file", nargs="?", type=Path, help="TOML file; the default housing's if not given"
    )
    sub.add_argument("--mesh-size", type=float, help="largest edge of an element in m")
    sub.add_argument(
        "-o", "--output", type=Path, help="folder or .zip file; results/FILE if not given"
    )
    sub.add_argument("--json", action="store_true", help="print one JSON object")
    sub = add("reduce", _reduce, "keep the modes that a band needs, with a certified error")
    sub.add_argument("data", type=Path, help="folder or .zip file of the format modal-housing")
    _band_options(sub)
    sub.set_defaults(tolerance=TOLERANCE)
    sub.add_argument("--for", dest="system", help="system whose scene decides on the band")
    sub.add_argument(
        "--scene",
        help="with --for: as far as what it asks has lines; a smaller --band is warned of",
    )
    sub = add("import", _import, "make modal data of another program's matrices or modes")
    sub.add_argument(
        "file", nargs="+", type=Path,
        help=".frd, .unv, .uff, .op4, .pch, .bdf; or K.mtx M.mtx and perhaps the seat input B.mtx",
    )  # fmt: skip
    sub.add_argument(
        "--seats",
        type=Path,
        help="TOML file: units, frame, nodes of the seats; fmus has a sample, seats.toml",
    )
    _band_options(sub)


def _band_options(sub: argparse.ArgumentParser) -> None:
    sub.add_argument(
        "--band", type=float, help=f"highest frequency of use in Hz; {BAND:g} if not given"
    )
    sub.add_argument(
        "--tolerance",
        type=float,
        help="error of the receptance at the seats, relative to the static compliance; "
        f"{TOLERANCE:g} if not given",
    )
    sub.add_argument(
        "-o", "--output", type=Path, help="folder or .zip file; under results if not given"
    )
    sub.add_argument("--json", action="store_true", help="print one JSON object")


def _reduce(options: argparse.Namespace) -> int:
    from herringbone.commands.housing.data import reduce_command  # noqa: PLC0415 (numba)

    return reduce_command(options)


def _import(options: argparse.Namespace) -> int:
    from herringbone.commands.housing.data import import_command  # noqa: PLC0415 (numba)

    return import_command(options)


def _build(options: argparse.Namespace) -> int:
    from tqdm import tqdm  # noqa: PLC0415 (only when something runs)

    from herringbone.components.registry import component_for  # noqa: PLC0415 (numba)
    from herringbone.core.declaring.roles import Role  # noqa: PLC0415
    from herringbone.housing import write_housing  # noqa: PLC0415 (only when it is asked for)
    from herringbone.housing.welded.build import STAGES, build_housing  # noqa: PLC0415
    from herringbone.housing.welded.design import read_design  # noqa: PLC0415

    file = options.file or component_for(Role.HOUSING).folder / "welded_housing.toml"
    design = read_design(file)
    output = options.output or Path("results") / file.stem
    check_writable(output.parent if output.suffix == ".zip" else output)
    with tqdm(total=STAGES, disable=None, bar_format=_BAR) as bar:

        def progress(what: str) -> None:
            bar.total = max(STAGES, bar.n + 1)
            bar.update()
            bar.set_description_str(what)

        found = build_housing(design, mesh_size=options.mesh_size, progress=progress)
    for warning in write_housing(found.model, output):
        say(f"herringbone: note: {warning}")
    show(_json(found, output) if options.json else _table(found, file, output))
    return 0


def _json(found: "BuiltHousing", output: Path) -> str:
    shares = found.shares
    modes = [
        {
            "frequency_hz": float(f),
            "rigid": dict(zip(shares.motions, map(float, rigid), strict=True)),
            "elastic": float(shares.elastic[k]),
            "base_plate": float(shares.base[k]),
            "strain": {name: float(share[k]) for name, share in shares.strain.items()},
        }
        for k, (f, rigid) in enumerate(zip(shares.frequency_hz, shares.rigid, strict=True))
    ]
    return json.dumps({
        "output": str(output),
        "mass": found.mass,
        "unknowns": found.unknowns,
        "frequency_hz": [float(f) for f in found.model.frequency_hz],
        "kind": found.model.kind,
        "certificate": dict(found.model.certificate),
        "modes": modes,
    })  # fmt: skip


def _table(found: "BuiltHousing", file: Path, output: Path) -> str:
    """Figures of the model, and what its lowest modes do."""
    model, shares = found.model, found.shares
    normal, certificate = model.kind.count("normal"), model.certificate
    lines = [
        f"Housing of {found.mass:.1f} kg, {found.unknowns} unknowns: {normal} normal and "
        f"{len(model.kind) - normal} residual modes",
        f"Receptance at the seats up to {certificate['band_hz']:g} Hz: error below "
        f"{percent(certificate['error_bound'])} of the static compliance",
        "",
        f"{'Hz':>8}  {'kinetic energy of the box [%]':<34}strain energy [%]",
    ]
    for k, f in enumerate(shares.frequency_hz):
        motion = dict(zip(shares.motions, shares.rigid[k], strict=True))
        motion |= {"elastic": shares.elastic[k]}
        strain = {name: share[k] for name, share in shares.strain.items()}
        lines.append(f"{f:8.2f}  {_largest(motion):<34}{_largest(strain)}")
    lines += [
        "T, R: rigid translation along, rotation about x (toward the wheel), y (up), z (axial)",
        "",
        f"Dimensions: {file}",
        f"Files: {output}",
    ]
    return "\n".join(lines)


def _largest(shares: dict[str, float]) -> str:
    found = sorted(shares.items(), key=lambda item: -item[1])
    return ", ".join(f"{name} {100 * share:.0f}" for name, share in found if share >= _LEAST_SHARE)

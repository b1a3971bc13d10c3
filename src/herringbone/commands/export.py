"""The command `export`: a system as .ssp file, or as one native FMU."""

import argparse
from pathlib import Path

from herringbone.commands.build import add_platform_options
from herringbone.commands.options import add_cells, add_scene, add_start_values, given_by
from herringbone.commands.output import check_writable, show
from herringbone.core.declaring.hosting import Given
from herringbone.core.declaring.roles import GEARS

_SHOWN = {
    "internals": "all variables of its parts, as locals",
    "nodes": "the signals' nodes, for masters that know them",
    "parameters": "all parameters",
    "me": "model exchange besides co-simulation",
}
"""Options that add variables."""


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the command's options."""
    add_scene(sub)
    sub.add_argument("--step", type=float, help="communication step size in s (.ssp only)")
    sub.add_argument("--as-fmu", action="store_true", help="one native FMU of the whole system")
    sub.add_argument(
        "--plan", action="store_true",
        help="with --as-fmu: plan what the scene asks, and leave out what the choice does",
    )  # fmt: skip
    sub.add_argument(
        "--outside",
        action="append",
        default=[],
        metavar="INSTANCE",
        help="leave this instance out of the FMU; what it feeds becomes inputs",
    )
    for gear in GEARS:
        sub.add_argument(
            f"--{gear}",
            choices=[given.value for given in Given],
            help=f"what the host gives at the {gear}'s flange; torque if not said",
        )
    sub.add_argument(
        "--outputs",
        nargs="+",
        default=[],
        metavar="PATTERN",
        help="further outputs of a gearbox FMU, such as '*.deflection'",
    )
    for name, text in _SHOWN.items():
        sub.add_argument(f"--{name}", action="store_true", help=f"a gearbox FMU with {text}")
    kind = sub.add_mutually_exclusive_group()
    kind.add_argument("--native", action="store_true", help="native FMUs in the .ssp; the default")
    kind.add_argument("--python", action="store_true", help="Python FMUs in the .ssp file")
    sub.add_argument(
        "--nested", action="store_true", help="keep nested systems in the .ssp, with connectors"
    )
    add_platform_options(sub)
    sub.add_argument(
        "-o",
        "--output",
        type=Path,
        help="file; if not given SYSTEM.ssp, with --as-fmu SYSTEM.fmu, and with --fmi 3 "
        "SYSTEM_fmi3.fmu; a .ssv file with --as-fmu: start values of the scene alone",
    )
    add_start_values(sub)
    add_cells(sub)


def run(options: argparse.Namespace) -> int:
    """Export, and show the file and what is to be known of it.

    Raises:
        HerringboneError: something about the options is wrong, or the export fails.
    """
    from herringbone.studies.exporting import export  # noqa: PLC0415 (numba: only when it exports)

    made = ""
    if options.output:
        check_writable(options.output.parent, options.output)
        made = "" if options.output.parent.exists() else str(options.output.parent)
    same = ("as_fmu", "scene", "step", "plan", "outside", "outputs", "python", "nested", *GEARS)
    file = export(
        options.system,
        options.output,
        **{name: getattr(options, name) for name in (*same, *_SHOWN)},
        platforms=options.platforms,
        fmi=options.fmi,
        **given_by(options),
        told=show,
    )
    show(str(file))
    if made:
        show(f"{made} was made for it: there was no such folder")
    return 0

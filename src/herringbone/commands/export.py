"""The command `export`: a system as .ssp file, or as one native FMU."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from herringbone.commands.build import add_platform_options, chosen_platforms, untested
from herringbone.commands.options import add_scene, add_start_values, given_by
from herringbone.commands.output import check_writable, show
from herringbone.core.declaring.hosting import Given, Wanted
from herringbone.core.declaring.roles import GEARS

if TYPE_CHECKING:
    from herringbone.scenes import Scene

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


def run(options: argparse.Namespace) -> int:
    """Export, and show the file and what is to be known of it.

    Raises:
        HerringboneError: something about the options is wrong, or the export fails.
    """
    _check(options)
    made = ""
    if options.output:
        check_writable(options.output.parent, options.output)
        made = "" if options.output.parent.exists() else str(options.output.parent)
    for line in (_one_fmu if options.as_fmu else _ssp_file)(options):
        show(line)
    if made:
        show(f"{made} was made for it: there was no such folder")
    return 0


def _check(options: argparse.Namespace) -> None:
    """Refuse options that belong to the other kind of file."""
    from herringbone.core import ParameterError  # noqa: PLC0415

    if options.as_fmu:
        if options.step is not None:
            raise ParameterError("--step belongs to .ssp files; an FMU takes any step")
        if options.nested or options.python:
            raise ParameterError("--nested and --python belong to .ssp files; leave out --as-fmu")
        return
    if options.plan:
        raise ParameterError("--plan: a leaner model is one FMU; add --as-fmu")
    if options.outside or options.fmi != 2 or _wanted(options) != Wanted():
        raise ParameterError(
            "--outside, --fmi, flanges and variables belong to one FMU; add --as-fmu"
        )
    if options.platforms and options.python:
        raise ParameterError("--platforms chooses among native FMUs; leave out --python")


def _one_fmu(options: argparse.Namespace) -> list[str]:
    """The whole system as one FMU."""
    from herringbone.cosim.structure.system_file import short_name  # noqa: PLC0415
    from herringbone.running.exporting.export import fmu_file_name  # noqa: PLC0415
    from herringbone.running.exporting.system_fmu import export_fmu  # noqa: PLC0415

    platforms = chosen_platforms(options)
    lines, scene = _planned(options) if options.plan else ([], options.scene)
    file = export_fmu(
        options.system,
        options.output or Path(fmu_file_name(short_name(options.system), options.fmi)),
        outside=options.outside,
        scene=scene,
        **given_by(options),
        platforms=platforms,
        fmi=options.fmi,
        wanted=_wanted(options),
    )
    return [*lines, str(file), *untested(platforms)]


def _ssp_file(options: argparse.Namespace) -> list[str]:
    """An FMU for each part, and how they are connected."""
    from herringbone.cosim.structure.system_file import short_name  # noqa: PLC0415
    from herringbone.running.exporting.export import export_ssp  # noqa: PLC0415

    platforms = chosen_platforms(options)
    file = export_ssp(
        options.system,
        options.output or Path(f"{short_name(options.system)}.ssp"),
        scene=options.scene,
        step=options.step,
        **given_by(options),
        native=not options.python,
        platforms=platforms,
        nested=options.nested,
    )
    return [str(file), *untested(platforms)]


def _planned(options: argparse.Namespace) -> "tuple[list[str], Scene]":
    """A plan's text, and its scene."""
    from herringbone.studies.planning.plan import plan  # noqa: PLC0415 (numba)
    from herringbone.studies.planning.text import plan_text  # noqa: PLC0415

    found = plan(options.system, scene=options.scene, **given_by(options), for_fmu=True)
    return plan_text(found), found.scene


def _wanted(options: argparse.Namespace) -> Wanted:
    """What the host of a gearbox gives and wants to see."""
    given = {gear: Given(getattr(options, gear)) for gear in GEARS if getattr(options, gear)}
    return Wanted(
        given,
        tuple(options.outputs),
        internals=options.internals,
        nodes=options.nodes,
        parameters=options.parameters,
        exchange=options.me,
    )

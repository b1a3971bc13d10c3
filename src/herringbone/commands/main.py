"""Command line: what `herringbone --help` shows."""

import argparse
import traceback
from collections.abc import Sequence
from contextlib import AbstractContextManager
from functools import cache, partial
from pathlib import Path
from typing import NoReturn

import herringbone
from herringbone.commands import bench as bench_command
from herringbone.commands import build as build_command
from herringbone.commands import compare as compare_command
from herringbone.commands import export as export_command
from herringbone.commands import plot as plot_command
from herringbone.commands import stability as stability_command
from herringbone.commands import template as template_command
from herringbone.commands.answers import Tell, Told, answered
from herringbone.commands.checking import check as check_command
from herringbone.commands.gear import command as gear_command
from herringbone.commands.housing import command as housing_command
from herringbone.commands.options import (
    add_cells,
    add_command,
    add_kind,
    add_operating_point,
    add_replacements,
    add_scene,
    add_start_values,
    given_by,
    operating_point,
    replacements,
    start_values,
)
from herringbone.commands.output import as_command, check_writable, say, show
from herringbone.commands.parser import BAD_INPUT, Parser
from herringbone.commands.run import command as run_command
from herringbone.commands.run import options as run_options
from herringbone.commands.studies import modes as modes_command
from herringbone.commands.studies import plan as plan_command
from herringbone.commands.studies import steady as steady_command
from herringbone.commands.studies import study as study_command
from herringbone.commands.studies import sweep as sweep_command
from herringbone.core import (
    EXIT_CODES,
    HerringboneError,
    OutcomeKind,
)
from herringbone.core.places.files import is_folder
from herringbone.cosim.cell.policy import Policy, foreign_fmu_policy


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    options = _parser().parse_args(arguments)
    try:
        with as_command(), _housing(options) as housing:
            code = options.command(options)
            for remark in housing.remarks:  # a run has told its own
                say(f"note: {remark}")
            return code
    except HerringboneError as error:
        say(f"herringbone: {error}")
        if options.debug:
            traceback.print_exc()
        return BAD_INPUT
    except KeyboardInterrupt:
        say("herringbone: interrupted")
        return EXIT_CODES[OutcomeKind.INTERRUPTED]


def _housing(options: argparse.Namespace) -> AbstractContextManager[Policy]:
    """How the command's foreign FMUs are housed."""
    return foreign_fmu_policy(
        in_process=getattr(options, "in_process", None),
        deadline=getattr(options, "call_deadline", None),
    )


class _Version(argparse.Action):
    """Shows the version, which takes longer to find than to show help."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> NoReturn:
        """Show it; the program ends."""
        show(herringbone.__version__)
        parser.exit()


@cache
def _parser() -> argparse.ArgumentParser:
    parser = Parser(prog="herringbone", description="FMI co-simulation of herringbone gearboxes")
    parser.add_argument("--version", action=_Version, nargs=0, help="show the version and exit")
    parser.add_argument("--debug", action="store_true", help="show tracebacks of errors")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    add = partial(add_command, commands)
    sub = add("list", _list, "list components, systems, scenes, algorithms; or one of them")
    sub.add_argument(
        "name", nargs="?", help="component, whose variables are shown; system; or studies"
    )
    build_command.add_options(add("build", _build, "build the Python or the native FMUs"))
    sub = add("check", check_command.run, "check an FMU: is it sound, and what is it")
    check_command.add_options(sub)
    run_options.add_options(add("run", _run, "run a system"))
    sub = add("compare", compare_command.run, "compare two results folders")
    compare_command.add_options(sub)
    sub = add("sweep", sweep_command.run, "run a system at many operating points")
    sweep_command.add_options(sub)
    sub = add("study", study_command.run, "the thesis' studies as a report with verdicts")
    study_command.add_options(sub)
    sub = add("steady", steady_command.run, "the periodic steady state at an operating point")
    steady_command.add_options(sub)
    sub = add(
        "plan", plan_command.run, "the least model and the solver that a scene's questions need"
    )
    plan_command.add_options(sub)
    sub = add("plot", plot_command.run, "pictures of a results folder or of a sweep's folder")
    plot_command.add_options(sub)
    sub = add("modes", modes_command.run, "natural modes: participation, Campbell diagram, shapes")
    modes_command.add_options(sub)
    _chart_options(add("chart", _chart, "draw error against cost of coupling algorithms"))
    sub = add("stability", _stability, "predict the stable steps of algorithms")
    _comparison_options(sub)
    stability_command.add_options(sub)
    add_replacements(sub)
    add_cells(sub)
    add_start_values(sub)
    bench_command.add_options(add("bench", _bench, "measure speed and size, side by side"))
    sub = add("export", _export, "export a system as .ssp for other masters, or as one native FMU")
    export_command.add_options(sub)
    add_start_values(sub)
    sub = add("template", template_command.run, "a file to begin with: gear, housing, system ...")
    template_command.add_options(sub)
    gear_command.register(commands)
    housing_command.register(commands)
    return parser


def _comparison_options(sub: argparse.ArgumentParser) -> None:
    """Options of the commands that compare algorithms on a scene."""
    add_scene(sub)
    add_operating_point(sub)
    sub.add_argument("--algorithm", nargs="+", help="NAME or NAME:key=value,...; all if not given")


def _chart_options(sub: argparse.ArgumentParser) -> None:
    _comparison_options(sub)
    sub.add_argument("--steps", type=float, nargs="+", help="communication step sizes in s")
    sub.add_argument(
        "--tolerances", type=float, nargs="+", help="relative errors: a curve of adaptive li"
    )
    sub.add_argument("--fuse", action="store_true", help="curves of the fused system, too")
    sub.add_argument("--t-end", type=float, help="duration of each run in s")
    add_kind(sub)
    add_replacements(sub)
    add_cells(sub)
    add_start_values(sub)
    sub.add_argument(
        "-o", "--output", type=Path, help="folder; results/chart-SYSTEM-SCENE if not given"
    )
    sub.add_argument("--json", action="store_true", help="print one JSON object")


def _run(options: argparse.Namespace) -> int:
    return run_command.run(options)


def _list(options: argparse.Namespace) -> int:
    own = options.name and is_folder(Path(options.name))  # whose scenes may come and go
    find = partial(_listed, options)
    show((find(say) if own else answered(options, find)).text)
    return 0


def _listed(options: argparse.Namespace, tell: Tell) -> Told:
    from herringbone.commands.listing import described, overview  # noqa: PLC0415

    del tell
    return Told(described(options.name) if options.name else overview(), None)


def _build(options: argparse.Namespace) -> int:
    for line in build_command.build(options):
        show(line)
    return 0


def _chart(options: argparse.Namespace) -> int:
    from herringbone.commands.chart import chart  # noqa: PLC0415 (numba: only when something runs)

    check_writable(options.output or Path("results"))
    given = {"algorithms": options.algorithm, **vars(options)}
    given = {name: given[name] for name in ("algorithms", "steps", "tolerances", "t_end")}
    text, outcome = chart(
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


def _stability(options: argparse.Namespace) -> int:
    show(stability_command.stability(options, start_values(options.set)))
    return 0


def _bench(options: argparse.Namespace) -> int:
    show(bench_command.bench(options))
    return 0


def _export(options: argparse.Namespace) -> int:
    for line in export_command.export(options, start_values(options.set)):
        show(line)
    return 0

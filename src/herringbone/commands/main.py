"""Command line: what `herringbone --help` shows."""

import argparse
import traceback
from collections.abc import Sequence
from contextlib import AbstractContextManager
from functools import cache
from typing import NoReturn, Protocol

import herringbone
from herringbone.commands import bench as bench_command
from herringbone.commands import build as build_command
from herringbone.commands import compare as compare_command
from herringbone.commands import export as export_command
from herringbone.commands import plot as plot_command
from herringbone.commands import stability as stability_command
from herringbone.commands import template as template_command
from herringbone.commands.chart import command as chart_command
from herringbone.commands.checking import check as check_command
from herringbone.commands.gear import command as gear_command
from herringbone.commands.housing import command as housing_command
from herringbone.commands.listing import command as listing_command
from herringbone.commands.options import add_command
from herringbone.commands.output import as_command, check_current_folder, say, show
from herringbone.commands.parser import BAD_INPUT, Parser
from herringbone.commands.run import command as run_command
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
from herringbone.core.process.termination import EXIT_CODE as TERMINATED
from herringbone.core.process.termination import is_terminating
from herringbone.cosim.cell.policy import Policy, foreign_fmu_policy


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    options = _parser().parse_args(arguments)
    try:
        with as_command(), _housing(options) as housing:
            check_current_folder()
            if getattr(options, "fresh", False):
                from herringbone.core.caching.tried import (  # noqa: PLC0415 (looks at all sources)
                    forget_tried,
                )

                forget_tried()
            code = options.command(options)
            for remark in housing.remarks:  # a run has told its own
                say(f"note: {remark}")
            return _by_signal() if code == EXIT_CODES[OutcomeKind.INTERRUPTED] else code
    except HerringboneError as error:
        say(f"herringbone: {error}")
        if options.debug:
            traceback.print_exc()
        return BAD_INPUT
    except KeyboardInterrupt:
        say("herringbone: interrupted")
        return _by_signal()


def _by_signal() -> int:
    """Exit code of what a signal has ended."""
    return TERMINATED if is_terminating() else EXIT_CODES[OutcomeKind.INTERRUPTED]


def _housing(options: argparse.Namespace) -> AbstractContextManager[Policy]:
    """How the command's foreign FMUs are housed."""
    return foreign_fmu_policy(
        in_process=getattr(options, "in_process", None),
        deadline=getattr(options, "call_deadline", None),
        longest_trial=getattr(options, "longest_trial", None),
        most_trial_steps=getattr(options, "most_trial_steps", None),
    )


class _Command(Protocol):
    """A module that is a command."""

    def add_options(self, sub: argparse.ArgumentParser) -> None:
        """Declare the command's options."""

    def run(self, options: argparse.Namespace) -> int:
        """Do it, and show what came out; returns the exit code."""


_COMMANDS: tuple[tuple[str, _Command, str], ...] = (
    ("list", listing_command, "list components, systems, scenes, algorithms; or one of them"),
    ("build", build_command, "build the Python or the native FMUs"),
    ("check", check_command, "check an FMU: is it sound, and what is it"),
    ("run", run_command, "run a system"),
    ("compare", compare_command, "compare two results folders"),
    ("sweep", sweep_command, "run a system at many operating points"),
    ("study", study_command, "the thesis' studies as a report with verdicts"),
    ("steady", steady_command, "the periodic steady state at an operating point"),
    ("plan", plan_command, "the least model and the solver that a scene's questions need"),
    ("plot", plot_command, "pictures of a results folder or of a sweep's folder"),
    ("modes", modes_command, "natural modes: participation, Campbell diagram, shapes"),
    ("chart", chart_command, "draw error against cost of coupling algorithms"),
    ("stability", stability_command, "predict the stable steps of algorithms"),
    ("bench", bench_command, "measure speed and size, side by side"),
    ("export", export_command, "export a system as .ssp for other masters, or as one native FMU"),
    ("template", template_command, "a file to begin with: gear, housing, system ..."),
)
"""In the order of the help; those of gears and housings have commands of their own, and follow."""


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
    for name, command, text in _COMMANDS:
        command.add_options(add_command(commands, name, command.run, text))
    gear_command.register(commands)
    housing_command.register(commands)
    return parser

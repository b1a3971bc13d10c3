"""The command `run`: a system, from its options to the report."""

import argparse
from contextlib import chdir, closing
from pathlib import Path
from typing import TYPE_CHECKING

from herringbone.commands.options import (
    assignments,
    given_by,
    operating_point,
    replacements,
)
from herringbone.commands.output import check_writable, limits_told, say, show
from herringbone.commands.run.options import SLOW, add_options, given_options
from herringbone.core import EXIT_CODES, Outcome, OutcomeKind, ParameterError
from herringbone.core.places.files import is_folder
from herringbone.core.process.termination import is_terminating
from herringbone.running.reporting.progress import Bar

if TYPE_CHECKING:
    from herringbone.result.result import Result
    from herringbone.running.output.resumed import Resumed
    from herringbone.running.output.run_output import RunOutput

__all__ = ["add_options", "run"]
_NOT_KEPT = frozenset({"command", "debug", "json", "output", "overwrite", "resume"})
"""What is not kept for `--resume`."""


def run(options: argparse.Namespace) -> int:
    """Run, write the report, and show the summary; returns the exit code.

    Raises:
        HerringboneError: something about the input is wrong, or files cannot be written.
    """
    from herringbone.running.reporting.summary import summary_text  # noqa: PLC0415

    if options.resume is None and options.system is None:
        raise ParameterError("give a system to run, or --resume FOLDER; see 'herringbone list'")
    if options.plan and options.resume is None:
        from herringbone.commands.run.planned import (  # noqa: PLC0415 (numba)
            as_chosen,
            planned,
            run_steady,
        )

        found = planned(options)
        if not found.choice.step:
            return EXIT_CODES[run_steady(options, found)]
        options = as_chosen(options, found)
    result = _ran(options) if options.resume is None else _resumed(options)
    show(result.to_json() if options.json else summary_text(result))
    told = {OutcomeKind.INTERRUPTED, OutcomeKind.COMPLETED}
    if result.outcome.message and result.outcome.kind not in told:
        say(_ended(result.outcome))
    return EXIT_CODES[result.outcome.kind] or _missed(result)


def _missed(result: "Result") -> int:
    """1, with the headline, if a tolerance that was asked for is not met; else 0."""
    if result.verification is None or not result.verification.missed:
        return 0
    say(f"herringbone: {result.outcome.message}; the results are complete")
    return 1


def _ran(options: argparse.Namespace, resumed: "Resumed | None" = None) -> "Result":
    """The result of a run, with its files."""
    from herringbone.cosim.structure.system_file import short_name  # noqa: PLC0415
    from herringbone.running import api  # noqa: PLC0415 (numba: only when something runs)
    from herringbone.running.output.run_output import RunOutput  # noqa: PLC0415

    check_writable(options.output or Path("results"))
    optional = {
        name: value
        for name in ("scene", "algorithm", "step", "tolerance", "t_end", "record_step", "start")
        if (value := getattr(options, name)) is not None
    }
    own = given_by(options)
    output = RunOutput(
        options.output,
        overwrite=options.overwrite,
        parquet=options.parquet,
        pictures=not options.no_pictures,
        asked={k: v for k, v in vars(options).items() if k not in _NOT_KEPT},
        system=short_name(options.system),
        resumed=resumed,
    )
    bar = Bar(always=False)
    with closing(bar), closing(output), output.explaining(), limits_told():
        result = api.run(
            options.system,
            **optional,
            **operating_point(options),
            fmu=options.fmu,
            replace_parts=replacements(options),
            **own,
            slow=_multiples(options.slow),
            probe=not options.no_probe,
            in_process=options.in_process,
            call_deadline=options.call_deadline,
            longest_trial=options.longest_trial,
            most_trial_steps=options.most_trial_steps,
            reference=options.reference,
            verify=options.verify,
            fuse=options.fuse,
            record=options.record,
            progress=bar.show,
            recorded=_Report(output, bar).write,
            output=output,
        )
        result = output.complete(result)
    for note in output.notes:
        say(f"herringbone: {note}")
    return result


def _resumed(options: argparse.Namespace) -> "Result":
    """The result of a run that goes on where it was cut off.

    Raises:
        HerringboneError: it cannot be resumed.
    """
    from herringbone.result.folder.checked_store import ReplayError  # noqa: PLC0415
    from herringbone.running.output.resumed import Resumed, to_resume  # noqa: PLC0415

    if set(given_options(options)) - {"resume", "json"}:
        raise ParameterError("--resume takes all options but --json from the folder; drop the rest")
    folder = options.resume.absolute()
    found = to_resume(folder)
    if not isinstance(found, Resumed):
        return found
    kept = {**found.run.asked, "output": folder, "resume": None}
    wanted = argparse.Namespace(**{**vars(options), **kept})
    if not is_folder(Path(found.run.folder)):
        raise ParameterError(f"the run was started in {found.run.folder}, which is not there")
    with chdir(found.run.folder):
        try:
            return _ran(wanted, found)
        except ReplayError:
            if found.state is None:
                raise
            say("herringbone: the last checkpoint does not repeat the rows; from the start again")
            return _ran(wanted, found.replayed())


def _ended(outcome: Outcome) -> str:
    return f"herringbone: {outcome.kind.value}: {outcome.message}"


class _Report:
    """The files of a run: written when it ends, before anything more is found out about it."""

    def __init__(self, output: "RunOutput", bar: Bar) -> None:
        self._output, self._bar = output, bar

    def write(self, result: "Result") -> None:
        """Write all files."""
        self._bar.close()
        shown = self._output.shown
        if is_terminating() and self._output.pictures:
            self._output.pictures = False
            say(f"herringbone: terminated: no pictures; 'herringbone plot {shown}' draws them")
        if result.outcome.kind is OutcomeKind.INTERRUPTED:
            say(
                f"{_ended(result.outcome)}, and are being written to {shown}; Ctrl-C again ends at "
                f"once, and 'herringbone run --resume {shown}' goes on from there"
            )
        self._output.write(result)
        if result.outcome.unstable:
            self._bar.tell(f"results are in {shown}; looking for what grows, and remedies")


def _multiples(text: str | None) -> dict[str, int]:
    """Whole numbers by instance, of an option that lists them."""
    found = {}
    for name, number in assignments(text.split(",") if text else [], "--slow", SLOW).items():
        if not number.isdecimal():
            raise ParameterError(f"--slow {name}={number}: it must be a whole number of steps")
        found[name] = int(number)
    return found

"""Command line: what `herringbone --help` shows."""

import argparse
import traceback
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NoReturn

from tqdm import tqdm

import herringbone
from herringbone import (
    bench_command,
    build_command,
    export_command,
    gear_command,
    housing_command,
    stability_command,
)
from herringbone.core import HerringboneError, OutcomeKind, ParameterError
from herringbone.output import check_writable, say, show

EXIT_CODES = {
    OutcomeKind.COMPLETED: 0,
    OutcomeKind.DIVERGED: 1,
    OutcomeKind.PART_FAILED: 1,
    OutcomeKind.COUPLING_FAILED: 1,
    OutcomeKind.STEP_LIMIT: 1,
    OutcomeKind.INTERRUPTED: 130,
}
BAD_INPUT = 2
_FMU = "native, python, in-process, or auto (default): native if there is a C compiler"
_OVERRIDE = "start value in SI units, instead of the scene's; may be repeated"
_SLOW = "INSTANCE=N,..."
_SET, _REPLACE = "INSTANCE.VARIABLE=VALUE", "INSTANCE=FILE.fmu"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    options = _parser().parse_args(arguments)
    try:
        return options.command(options)
    except HerringboneError as error:
        say(f"herringbone: {error}")
        if options.debug:
            traceback.print_exc()
        return BAD_INPUT
    except KeyboardInterrupt:
        say("herringbone: interrupted")
        return EXIT_CODES[OutcomeKind.INTERRUPTED]


class _Parser(argparse.ArgumentParser):
    """A parser whose errors are one line."""

    def error(self, message: str) -> NoReturn:
        """Say what is wrong, and end with the exit code of bad input."""
        self.exit(BAD_INPUT, f"{self.prog}: {message}; see '{self.prog} --help'\n")


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog="herringbone", description="FMI co-simulation of herringbone gearboxes")
    parser.add_argument("--version", action="version", version=herringbone.__version__)
    parser.add_argument("--debug", action="store_true", help="show tracebacks of errors")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    def add(name: str, command: Callable, text: str) -> argparse.ArgumentParser:
        sub = commands.add_parser(name, help=text, description=text)
        sub.set_defaults(command=command)
        return sub

    sub = add("list", _list, "list components, systems, scenes, algorithms; or one component")
    sub.add_argument("name", nargs="?", help="component whose variables are shown")
    build_command.add_options(add("build", _build, "build the Python or the native FMUs"))
    sub = add("check", _check, "check an FMU: file, description, a step, state, reset")
    sub.add_argument("fmu", type=Path, metavar="FILE.fmu", help="FMU of FMI 2 or 3")
    sub.add_argument("--as", dest="role", choices=["housing"], help="also test what it must do")
    sub.add_argument("--against", type=Path, help="modal data whose static compliance it has")
    _run_options(add("run", _run, "run a system"))
    _chart_options(add("chart", _chart, "draw error against cost of coupling algorithms"))
    sub = add("stability", _stability, "predict the stable steps of algorithms")
    _comparison_options(sub)
    stability_command.add_options(sub)
    sub.add_argument("--set", action="append", default=[], metavar=_SET, help=_OVERRIDE)
    bench_command.add_options(add("bench", _bench, "measure speed and size, side by side"))
    sub = add("export", _export, "export a system as .ssp for other masters, or as one native FMU")
    export_command.add_options(sub)
    sub.add_argument("--set", action="append", default=[], metavar=_SET, help=_OVERRIDE)
    gear_command.register(commands)
    housing_command.register(commands)
    return parser


def _scene_options(sub: argparse.ArgumentParser) -> None:
    sub.add_argument("system", help="name of a shipped system, folder, or .ssp file")
    sub.add_argument("--scene", help="name or TOML file; 'loaded' if the system has it")


def _run_options(sub: argparse.ArgumentParser) -> None:
    _scene_options(sub)
    sub.add_argument(
        "--algorithm", help="NAME or NAME:key=value,..., e.g. li:degree=3; auto if not given"
    )
    sub.add_argument(
        "--step", type=float, help="communication step size in s; the largest, with --tolerance"
    )
    sub.add_argument(
        "--tolerance", type=float, help="relative error for which li adapts its step, e.g. 1e-3"
    )
    sub.add_argument(
        "--slow", metavar=_SLOW, help="heavy bodies that step once in N communication steps"
    )
    sub.add_argument("--t-end", type=float, help="duration in s")
    sub.add_argument("--record-step", type=float, help="time between records in s")
    sub.add_argument("--start", help="equilibrium, ramp or rest; the scene's if not given")
    sub.add_argument("--fmu", default="auto", help=_FMU)
    sub.add_argument(
        "--replace", action="append", default=[], metavar=_REPLACE,
        help="FMU in the place of an instance; may be repeated",
    )  # fmt: skip
    sub.add_argument("--set", action="append", default=[], metavar=_SET, help=_OVERRIDE)
    sub.add_argument("--reference", action="store_true", help="errors against the monolithic twin")
    sub.add_argument("--parquet", action="store_true", help="also write results.parquet")
    sub.add_argument("-o", "--output", type=Path, help="folder; results/SYSTEM-SCENE if not given")
    sub.add_argument("--json", action="store_true", help="print one JSON object")


def _comparison_options(sub: argparse.ArgumentParser) -> None:
    """Options of the commands that compare algorithms on a scene."""
    _scene_options(sub)
    sub.add_argument("--algorithm", nargs="+", help="NAME or NAME:key=value,...; all if not given")


def _chart_options(sub: argparse.ArgumentParser) -> None:
    _comparison_options(sub)
    sub.add_argument("--steps", type=float, nargs="+", help="communication step sizes in s")
    sub.add_argument("--t-end", type=float, help="duration of each run in s")
    sub.add_argument("--fmu", default="auto", help=_FMU)
    sub.add_argument(
        "-o", "--output", type=Path, help="folder; results/chart-SYSTEM-SCENE if not given"
    )
    sub.add_argument("--json", action="store_true", help="print one JSON object")


def _assignments(items: Sequence[str], option: str, form: str) -> dict[str, str]:
    found = {}
    for item in items:
        name, equals, value = item.partition("=")
        if not equals or not name or not value:
            raise ParameterError(f"{option} {item}: it must be {form}")
        found[name] = value
    return found


def _multiples(text: str | None) -> dict[str, int]:
    """Whole numbers by instance, of an option that lists them."""
    found = {}
    for name, number in _assignments(text.split(",") if text else [], "--slow", _SLOW).items():
        if not number.isdecimal():
            raise ParameterError(f"--slow {name}={number}: it must be a whole number of steps")
        found[name] = int(number)
    return found


def _values(items: Sequence[str]) -> dict[str, float | str]:
    """Numbers where they read as numbers, text otherwise."""
    found: dict[str, float | str] = {}
    for name, text in _assignments(items, "--set", _SET).items():
        try:
            found[name] = float(text)
        except ValueError:
            found[name] = text
    return found


def _run(options: argparse.Namespace) -> int:
    from herringbone import api  # noqa: PLC0415 (numba: only when something runs)
    from herringbone.report import summary_text, write_report  # noqa: PLC0415

    check_writable(options.output or Path("results"))
    optional = {
        name: value
        for name in ("scene", "algorithm", "step", "tolerance", "t_end", "record_step", "start")
        if (value := getattr(options, name)) is not None
    }
    with _Bar() as bar:
        result = api.run(
            options.system,
            **optional,
            fmu=options.fmu,
            replace_parts=_assignments(options.replace, "--replace", _REPLACE),
            values=_values(options.set),
            slow=_multiples(options.slow),
            reference=options.reference,
            progress=bar.show,
        )
    name = Path(options.system).stem
    folder = options.output or Path("results") / f"{name}-{result.info.scene}"
    result = write_report(result, folder, parquet=options.parquet)
    show(result.to_json() if options.json else summary_text(result))
    if result.outcome.message:
        say(f"herringbone: {result.outcome.kind.value}: {result.outcome.message}")
    return EXIT_CODES[result.outcome.kind]


class _Bar:
    """Progress bar of simulated milliseconds, on a terminal only."""

    def __enter__(self) -> "_Bar":
        self._bar: tqdm | None = None
        return self

    def show(self, reached: float, t_end: float) -> None:
        """Move the bar to a simulated time [s]."""
        if self._bar is None:
            self._bar = tqdm(
                total=round(1e3 * t_end, 3),
                unit="ms",
                disable=None,
                bar_format="{l_bar}{bar}| {n:.1f}/{total:.1f} ms simulated [{elapsed}<{remaining}]",
            )
        self._bar.update(1e3 * reached - self._bar.n)

    def __exit__(self, *exception: object) -> None:
        if self._bar is not None:
            self._bar.close()


def _list(options: argparse.Namespace) -> int:
    from herringbone.listing import describe_component, overview  # noqa: PLC0415

    show(describe_component(options.name) if options.name else overview())
    return 0


def _build(options: argparse.Namespace) -> int:
    for line in build_command.build(options):
        show(line)
    return 0


def _check(options: argparse.Namespace) -> int:
    if options.against and not options.role:
        raise ParameterError("--against belongs to the test of a housing; add --as housing")
    if options.role:
        from herringbone.housing_check import check_command  # noqa: PLC0415 (numba)

        return check_command(options.fmu, options.against)
    from herringbone.fmi.check import check_fmu  # noqa: PLC0415

    problems = check_fmu(options.fmu)
    for problem in problems:
        show(problem)
    show(
        f"{options.fmu}: {len(problems)} problem(s)" if problems else f"{options.fmu}: no problems"
    )
    return 1 if problems else 0


def _chart(options: argparse.Namespace) -> int:
    from herringbone.chart_command import chart  # noqa: PLC0415 (numba: only when something runs)

    check_writable(options.output or Path("results"))
    given = {"algorithms": options.algorithm, "steps": options.steps, "t_end": options.t_end}
    text, outcome = chart(
        options.system,
        options.output,
        as_json=options.json,
        scene=options.scene,
        fmu=options.fmu,
        **{name: value for name, value in given.items() if value is not None},
    )
    show(text)
    return EXIT_CODES[outcome]


def _stability(options: argparse.Namespace) -> int:
    show(stability_command.stability(options, _values(options.set)))
    return 0


def _bench(options: argparse.Namespace) -> int:
    show(bench_command.bench(options))
    return 0


def _export(options: argparse.Namespace) -> int:
    for line in export_command.export(options, _values(options.set)):
        show(line)
    return 0

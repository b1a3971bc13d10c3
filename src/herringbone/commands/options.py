"""What several commands share: how they are declared, their options, and what these stand for."""

import argparse
import contextlib
import math
import re
from collections.abc import Callable, Sequence
from decimal import Decimal
from pathlib import Path
from typing import Any, TypedDict

from herringbone.core import ParameterError
from herringbone.core.declaring.units import R_MIN

_SET, _REPLACE = "INSTANCE.VARIABLE=VALUE", "INSTANCE=FILE.fmu"
_QUOTED = re.compile(r'"([^"]*)"=(.*)', re.DOTALL)
_WHOLE = 2.0**53
"""Up to here doubles hold all whole numbers."""
_MOST = 2**64
"""No integer of FMI is as large."""
_USUAL_SPREAD = 1.0
"""By what share assumed parameters may err: known within a factor of 2."""

ANY_KIND = "auto"
"""Of FMUs, if none is asked for."""


def add_command(
    commands: Any,  # noqa: ANN401 (argparse's type is private)
    name: str,
    command: Callable[[argparse.Namespace], int],
    text: str,
) -> argparse.ArgumentParser:
    """Declare a command, and what runs it."""
    sub = commands.add_parser(name, help=text, description=text)
    sub.set_defaults(command=command)
    return sub


def add_scene(sub: argparse.ArgumentParser, *, optional: bool = False) -> None:
    """Declare what is run; optional where a folder may tell it."""
    sub.add_argument(
        "system", nargs="?" if optional else None,
        help="name of a shipped system, folder, or .ssp file",
    )  # fmt: skip
    sub.add_argument("--scene", help="name or TOML file; 'loaded' if the system has it")


def add_operating_point(sub: argparse.ArgumentParser) -> None:
    """Declare speed and torque; see `operating_point`."""
    sub.add_argument(
        "--speed", type=float,
        help="speed set point in r/min, as 'list' names it: of its own shaft, most often the "
        "pinion's; the scene's if not given",
    )  # fmt: skip
    sub.add_argument(
        "--torque", type=float,
        help="torque set point in N m, of the pinion; of a source or load that has its own, of its "
        "shaft; the scene's if not given",
    )  # fmt: skip


def add_comparison(sub: argparse.ArgumentParser) -> None:
    """Declare scene, operating point and algorithms, of commands that compare these."""
    add_scene(sub)
    add_operating_point(sub)
    sub.add_argument("--algorithm", nargs="+", help="NAME or NAME:key=value,...; all if not given")


def add_kind(sub: argparse.ArgumentParser) -> None:
    """Declare the kind of the parts' FMUs."""
    sub.add_argument(
        "--fmu",
        default=ANY_KIND,
        help="native, python, in-process, or auto (default): native if there is a C compiler",
    )


def add_cells(sub: argparse.ArgumentParser) -> None:
    """Declare how foreign FMUs are housed."""
    housed = sub.add_mutually_exclusive_group()
    housed.add_argument(
        "--cells", dest="in_process", action="store_false", default=None,
        help="run each foreign FMU in a child process of its own, which may crash: the default "
        "on Linux",
    )  # fmt: skip
    housed.add_argument(
        "--in-process", action="store_true", default=None,
        help="load foreign FMUs into this process",
    )  # fmt: skip
    sub.add_argument(
        "--call-deadline", type=float, metavar="SECONDS",
        help="longest time that a call of an FMU in a child process may take; 60 s if not given",
    )  # fmt: skip
    sub.add_argument(
        "--longest-trial", type=int, metavar="STEPS",
        help="of a trial for the test of a role, as that of a housing before it is coupled: of a "
        "slow FMU a test that takes a longer one is left out, and says so; as many as the tests "
        "want",
    )  # fmt: skip
    sub.add_argument(
        "--most-trial-steps", type=int, metavar="STEPS",
        help="of all trials of a foreign FMU together, but for the test of a housing: what they "
        "do not tell stays unknown, as a line says; any number if not given",
    )  # fmt: skip
    sub.add_argument(
        "--fresh", action="store_true",
        help="forget what trials of foreign FMUs told before, of all, and make them anew: of FMUs "
        "that read what their files do not show",
    )  # fmt: skip


def add_start_values(sub: argparse.ArgumentParser, varied: str = "") -> None:
    """Declare start values, gears and housings; see `start_values`, `files_of_parts`.

    Args:
        sub: of the command.
        varied: what the command takes besides single values, for its help.
    """
    sub.add_argument(
        "--gear", action="append", default=[], metavar="[PATH=]FILE",
        help="gear file (.toml; .rexs, of several stages as FILE#STAGE) of the gear pair, or of "
        "the one at PATH; sets all parts that belong to it",
    )  # fmt: skip
    sub.add_argument(
        "--housing", action="append", default=[], metavar="[PATH=]DATA",
        help="folder of modal data, dimensions of a welded housing (.toml) or FMU of the housing",
    )  # fmt: skip
    sub.add_argument(
        "--set",
        action="append",
        default=[],
        metavar=_SET,
        help=f"start value in SI units, of an FMU in its own, instead of the scene's; {varied}a "
        "name with = stands in quotes; may be repeated",
    )


def add_replacements(sub: argparse.ArgumentParser) -> None:
    """Declare FMUs in the place of instances; see `replacements`."""
    sub.add_argument(
        "--replace", action="append", default=[], metavar=_REPLACE,
        help="FMU in the place of an instance; may be repeated",
    )  # fmt: skip


def add_sensitivities(sub: argparse.ArgumentParser) -> None:
    """Declare what levels are to be differentiated over."""
    sub.add_argument(
        "--sensitivities", nargs="*", metavar="PARAMETER",
        help="of the levels of all groups to these parameters or patterns; to all dampings if none "
        "is named",
    )  # fmt: skip
    sub.add_argument(
        "--known-within", type=float, metavar="FACTOR",
        help="factor within which such parameters are known, for bands and tornado plots; 2 if not "
        "given",
    )  # fmt: skip


def add_solver(sub: argparse.ArgumentParser) -> None:
    """Declare what is to find a steady state."""
    sub.add_argument(
        "--solver", choices=("auto", "shooting"),
        help="auto: harmonic balance, and what else finds a motion where that does not; shooting",
    )  # fmt: skip


def spread_of(options: argparse.Namespace) -> float:
    """By what share parameters may err; raises ParameterError."""
    factor = options.known_within
    if factor is None:
        return _USUAL_SPREAD
    if options.sensitivities is None:
        raise ParameterError(
            f"--known-within {factor:g}: of the parameters of --sensitivities; add that"
        )
    if not 1.0 <= factor < math.inf:
        raise ParameterError(f"--known-within {factor:g}: it is a factor, at least 1")
    return factor - 1.0


def replacements(options: argparse.Namespace) -> dict[str, str]:
    """FMU files by instance.

    Raises:
        ParameterError: an item is no assignment.
    """
    return assignments(options.replace, "--replace", _REPLACE)


def start_values(items: Sequence[str], form: str = _SET) -> dict[str, float | str]:
    """Numbers where they read as numbers, text otherwise, by `instance.variable`.

    Whole numbers that no double holds stay as they are; quotes make a number a text.

    Args:
        items: as given.
        form: what an item looks like.

    Raises:
        ParameterError: an item is no assignment.
    """
    found: dict[str, float | str] = {}
    for name, text in assignments(items, "--set", form).items():
        try:
            found[name] = _number(text)
        except ValueError:
            quoted = len(text) > 1 and text[0] == text[-1] == '"'
            found[name] = text[1:-1] if quoted else text
    return found


def _number(text: str) -> float:
    """A number of a text, without loss; raises ValueError."""
    value = float(text)
    if abs(value) < _WHOLE or not math.isfinite(value):
        return value
    with contextlib.suppress(ValueError):
        return int(text)
    exact = Decimal(text)
    lossy = abs(exact) < _MOST and exact != Decimal(value) and exact == exact.to_integral_value()
    return int(exact) if lossy else value


class OperatingPoint(TypedDict):
    """Speed [rad/s] and torque [N m] at the pinion; None: the scene's."""

    speed: float | None
    torque: float | None


def operating_point(options: argparse.Namespace) -> OperatingPoint:
    """What `add_operating_point` declares, as whatever takes a system takes it."""
    speed = None if options.speed is None else options.speed / R_MIN
    return OperatingPoint(speed=speed, torque=options.torque)


class PartFiles(TypedDict):
    """Files of gear pairs and housings by path of their part; "": of the only one."""

    gear: dict[str, Path]
    housing: dict[str, Path]


class Given(PartFiles):
    """What `add_start_values` declares, as whatever takes a system takes it."""

    values: dict[str, float | str]


def given_by(options: argparse.Namespace) -> Given:
    """What --set, --gear and --housing give.

    Raises:
        ParameterError: an item is no assignment, or there are two for the same part.
    """
    return Given(values=start_values(options.set), **files_of_parts(options))


def files_of_parts(options: argparse.Namespace) -> PartFiles:
    """What --gear and --housing give.

    Raises:
        ParameterError: two for the same part, or a list of files.
    """
    found = PartFiles(gear={}, housing={})
    for name, files in (("gear", found["gear"]), ("housing", found["housing"])):
        for item in getattr(options, name):
            path, equals, file = item.partition("=")
            path, file = (path, file) if equals and not Path(item).exists() else ("", item)
            if "," in file and not Path(file).exists():
                raise ParameterError(
                    f"--{name} {item}: it takes one file; for a study over several call "
                    f"hb.steady(SYSTEM, {name}=FILE) in a loop, in Python"
                )
            if path in files:
                where = f"for '{path}'" if path else "without a path"
                raise ParameterError(
                    f"--{name} {item}: it is given twice {where}; write PATH=FILE, each PATH once"
                )
            files[path] = Path(file)
    return found


def assignments(items: Sequence[str], option: str, form: str) -> dict[str, str]:
    """Names and values of the items NAME=VALUE of an option.

    A name that has a "=", as variables of FMUs may, stands in quotes: "NAME"=VALUE.

    Args:
        items: as given.
        option: its name.
        form: what an item looks like.

    Raises:
        ParameterError: an item has another form.
    """
    found = {}
    for item in items:
        quoted = _QUOTED.fullmatch(item)
        name, value = quoted.groups() if quoted else item.partition("=")[::2]
        if not name or not value or name[0] == '"':
            raise ParameterError(f"{option} {item}: it must be {form}")
        found[name] = value
    return found


def refuse_given(options: argparse.Namespace, names: Sequence[str], why: str) -> None:
    """Raise ParameterError if any of some options is given: why it does not go with the others."""
    for name in names:
        if getattr(options, name) not in (None, []):
            raise ParameterError(f"--{name.replace('_', '-')}: {why}")

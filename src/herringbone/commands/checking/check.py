"""The command `check`: whether an FMU is sound, what it is in a coupling, and a role's contract."""

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

from herringbone.commands.answers import Told, answered
from herringbone.commands.options import add_cells
from herringbone.commands.output import show
from herringbone.core import FmuError, ParameterError

if TYPE_CHECKING:
    from herringbone.core.part import Part

_ROLES = ["housing", "motor", "load", "coupling"]

_SHORTER = (1e-4, 2e-5, 5e-6)
"""Steps of further trials [s] while something is not clear: an FMU of a gearbox proposes 1 ms, and
vibrates at kilohertz."""
_USABLE = (
    "what departs from FMI in its description is up to the tool that made it, and does not keep it "
    "from being used here"
)


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the command's options."""
    sub.add_argument("fmu", type=Path, metavar="FILE.fmu", help="FMU of FMI 2 or 3")
    sub.add_argument(
        "--as", dest="role", choices=_ROLES, help="test what it must do as one instead"
    )
    sub.add_argument("--against", type=Path, help="modal data whose static compliance it has")
    sub.add_argument(
        "--flange",
        action="append",
        metavar="PORT",
        help="flange of a motor, load or coupling: its port, or tau=NAME,phi=NAME,w=NAME; guessed",
    )
    sub.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="VARIABLE=VALUE",
        help="start value for the test of a role, as its speed; may be repeated",
    )
    sub.add_argument(
        "--step",
        type=float,
        help="of the trials that tell what it is [s]; that of the FMU, and shorter ones where that "
        "leaves something open",
    )
    sub.add_argument("--json", action="store_true", help="the contract's tests as JSON")
    add_cells(sub)


def run(options: argparse.Namespace) -> int:
    """Show problems of an FMU and its signature, or a contract; 1 if there are problems.

    Raises:
        HerringboneError: the file cannot be used, or an option is wrong.
    """
    _refuse_wrong(options)
    if options.role:
        told = answered(options, lambda _: _contract(options))
        show(json.dumps(told.summary, indent=1) if options.json else told.text)
        return 0 if told.summary["holds"] else 1
    from herringbone.fmi.check import check_fmu  # noqa: PLC0415

    problems = check_fmu(options.fmu)
    for problem in problems:
        show(problem)
    show(
        f"{options.fmu}: {len(problems)} problem(s)" if problems else f"{options.fmu}: no problems"
    )
    signature = _signature(options.fmu, options.step)
    usable = [_USABLE] if problems and signature else []
    for line in (*usable, *_remarks(options.fmu), *signature):
        show(f"  {line}")
    return 1 if problems else 0


def _contract(options: argparse.Namespace) -> Told:
    """What holds of a role's contract; raises HerringboneError."""
    from herringbone.commands.checking.contract import told_of  # noqa: PLC0415 (numba)

    return told_of(options)


def _asked_as(part: "Part", fmu: Path) -> list[str]:
    """The role that an FMU's variables are those of, and how it is tested."""
    from herringbone.analysis.housing.contract import looks_like_housing  # noqa: PLC0415 (numba)

    if not looks_like_housing(part):
        return []
    return [
        "it has the variables of a housing; what it must do as one is tested by 'herringbone check "
        f"{fmu} --as housing'"
    ]


def _remarks(fmu: Path) -> list[str]:
    """What FMI allows, but leaves open; nothing if the file cannot be read, which is said."""
    from herringbone.fmi.check import without_unit  # noqa: PLC0415

    try:
        names = [line.partition(":")[0] for line in without_unit(fmu)]
    except FmuError:
        return []
    if not names:
        return []
    return [f"remark: without unit, taken as SI: {', '.join(names)} (Real, {len(names)} in all)"]


def _refuse_wrong(options: argparse.Namespace) -> None:
    """Raises ParameterError for options that have no meaning."""
    if options.against and options.role != "housing":
        raise ParameterError("--against belongs to the test of a housing; add --as housing")
    if options.flange and options.role in {None, "housing"}:
        raise ParameterError("--flange belongs to the test of a motor, load or coupling; add --as")
    if options.json and not options.role:
        raise ParameterError("--json belongs to the test of a role; add --as")
    if options.set and not options.role:
        raise ParameterError("--set belongs to the test of a role; add --as")
    if options.longest_trial is not None and not options.role:
        raise ParameterError("--longest-trial belongs to the test of a role; add --as")
    if options.step is not None and not options.step > 0.0:
        raise ParameterError(f"--step {options.step:g}: it must be positive, in s")


def _signature(fmu: Path, step: float | None) -> list[str]:
    """What the FMU is in a coupling; nothing if it cannot be used at all, which is said already."""
    from herringbone.cosim.fmu.opening import many_of  # noqa: PLC0415
    from herringbone.cosim.signature.text import described  # noqa: PLC0415
    from herringbone.running.foreign.started import own_step, started_content  # noqa: PLC0415
    from herringbone.running.foreign.trials import clearest_signature  # noqa: PLC0415 (numba)

    try:
        steps = (step,) if step else (own_step(fmu), *_SHORTER)
        with many_of(fmu.stem, fmu) as make:
            part = make()
            part.enter_initialization(0.0, 1.0)
            part.exit_initialization()  # pythonfmu does not survive freeing what was not
            try:
                found = clearest_signature(part, make, steps, started_content(fmu, {}))
                return [*described(found), *_asked_as(part, fmu)]
            finally:
                part.close()
    except FmuError:
        return []

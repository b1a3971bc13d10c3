"""What `herringbone check FMU --as ROLE` shows: the contract of a role, one line a test."""

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from tqdm import tqdm

from herringbone.analysis.finding import Finding, Verdict, not_tested
from herringbone.analysis.flange.contract import check_flanges
from herringbone.analysis.housing.contract import STEP, usual_compliance
from herringbone.commands.answers import Told
from herringbone.commands.options import start_values
from herringbone.core.declaring.roles import Role
from herringbone.core.process.telling import Tell
from herringbone.cosim.fmu.opening import many_of
from herringbone.housing import read_housing
from herringbone.running.foreign.started import own_step, started, started_content
from herringbone.running.housings.tested import Tested, tested_housing

ROLES = {
    "housing": Role.HOUSING,
    "motor": Role.DRIVE,
    "load": Role.LOAD,
    "coupling": Role.COUPLING,
}
_SET = "VARIABLE=VALUE"
_HEADER = ("test", "verdict", "measured", "limit")


def told_of(options: argparse.Namespace) -> Told:
    """What holds, one line a test.

    Args:
        options: of the command `check`, with a role.

    Raises:
        HerringboneError: the FMU cannot be used, or does not step.
    """
    housing = ROLES[options.role] is Role.HOUSING
    with tqdm(disable=None, bar_format="[{elapsed}] {desc}") as bar:
        of_role = _of_housing if housing else _of_flanges
        (findings, repeats), step = of_role(options, bar.set_description_str)
    failed = sum(not finding.holds for finding in findings)
    untested = sum(finding.verdict is Verdict.NOT_TESTED for finding in findings)
    remarks = sum(finding.verdict is Verdict.REMARK for finding in findings)
    said = f"{failed} test(s) fail" if failed else "nothing fails" if untested else "all tests hold"
    said = f"{said}, {untested} not possible" if untested else said
    said = f"{said}; {remarks} remark(s)" if remarks else said
    head = f"{options.fmu} as {options.role}, steps of {1e6 * step:g} us:"
    rows = [dict(zip(_HEADER, _cells(finding), strict=True)) for finding in findings]
    found = {"fmu": str(options.fmu), "role": options.role, "step": step, "holds": not failed}
    return Told(f"{head}\n{_table(findings)}\n{said}", {**found, "tests": rows}, again=repeats)


def _of_housing(options: argparse.Namespace, progress: Tell) -> tuple[Tested, float]:
    """What tests of a housing find, and the step of the trials [s]."""
    step = options.step or STEP
    found = tested_housing(
        options.fmu,
        usual_compliance(),
        start_values(options.set, _SET),
        static=None if options.against is None else _static(options.against),
        step=step,
        longest=options.longest_trial,
        progress=progress,
    )
    return found, step


def _of_flanges(options: argparse.Namespace, progress: Tell) -> tuple[Tested, float]:
    """What tests of a motor, load or coupling find, whose trials are known; and their step [s]."""
    fmu, values = options.fmu, start_values(options.set, _SET)
    step = options.step or own_step(fmu)
    with many_of(fmu.stem, fmu) as new:
        found = check_flanges(
            started(new, values),
            ROLES[options.role],
            step=step,
            flanges=options.flange or (),
            longest=options.longest_trial,
            progress=progress,
            content=started_content(fmu, values),
        )
    return Tested(found, repeats=False), step


def _static(against: Path) -> np.ndarray:
    housing = read_housing(against)
    return housing.static_compliance() if housing.static is None else housing.static


def _cells(finding: Finding) -> tuple[str, ...]:
    return finding.test, str(finding.verdict), finding.measured, finding.limit


def _table(findings: Sequence[Finding]) -> str:
    rows = [_HEADER, *map(_cells, _said_once(findings))]
    widths = [max(len(row[k]) for row in rows) for k in range(len(_HEADER))]
    return "\n".join(
        "  " + "  ".join(cell.ljust(w) for cell, w in zip(row, widths, strict=True)).rstrip()
        for row in rows
    )


def _said_once(findings: Sequence[Finding]) -> Iterator[Finding]:
    """The findings; those that were not possible for a reason that stands above refer to it."""
    told: dict[str, str] = {}
    for finding in findings:
        first = finding.test
        if finding.verdict is Verdict.NOT_TESTED:
            first = told.setdefault(finding.measured, first)
        yield finding if first == finding.test else not_tested(finding.test, f"see '{first}'")

"""What `herringbone check FMU --as ROLE` shows: the contract of a role, one line a test."""

import argparse
import json
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from tqdm import tqdm

from herringbone.analysis.finding import Finding, Report, Verdict, not_tested
from herringbone.analysis.flange.contract import check_flanges
from herringbone.analysis.housing.contract import STEP, check_housing, usual_compliance
from herringbone.commands.options import start_values
from herringbone.commands.output import show
from herringbone.core.declaring.roles import Role
from herringbone.cosim.fmu.opening import many_of
from herringbone.housing import read_housing
from herringbone.running.foreign.started import own_step, started, started_content

ROLES = {
    "housing": Role.HOUSING,
    "motor": Role.DRIVE,
    "load": Role.LOAD,
    "coupling": Role.COUPLING,
}
_HEADER = ("test", "verdict", "measured", "limit")


def check_command(options: argparse.Namespace) -> int:
    """Show what holds, one line a test; 1 if something does not.

    Args:
        options: of the command `check`, with a role.

    Raises:
        HerringboneError: the FMU cannot be used, or does not step.
    """
    with tqdm(disable=None, bar_format="[{elapsed}] {desc}") as bar:
        findings, step = _tested(options, bar.set_description_str)
    failed = sum(not finding.holds for finding in findings)
    untested = sum(finding.verdict is Verdict.NOT_TESTED for finding in findings)
    if options.json:
        rows = [dict(zip(_HEADER, _cells(finding), strict=True)) for finding in findings]
        found = {"fmu": str(options.fmu), "role": options.role, "step": step, "holds": not failed}
        show(json.dumps({**found, "tests": rows}, indent=1))
        return 1 if failed else 0
    show(f"{options.fmu} as {options.role}, steps of {1e6 * step:g} us:\n{_table(findings)}")
    remarks = sum(finding.verdict is Verdict.REMARK for finding in findings)
    said = f"{failed} test(s) fail" if failed else "nothing fails" if untested else "all tests hold"
    said = f"{said}, {untested} not possible" if untested else said
    show(f"{said}; {remarks} remark(s)" if remarks else said)
    return 1 if failed else 0


def _tested(options: argparse.Namespace, progress: Report) -> tuple[list[Finding], float]:
    """Findings, and the step of the trials [s]."""
    role, fmu, longest = ROLES[options.role], options.fmu, options.longest_trial
    with many_of(fmu.stem, fmu) as new:
        values = start_values(options.set, "VARIABLE=VALUE")
        make = started(new, values)
        if role is Role.HOUSING:
            step = options.step or STEP
            static = None if options.against is None else _static(options.against)
            usual = usual_compliance()
            found = check_housing(
                make, static=static, usual=usual, step=step, longest=longest, progress=progress
            )
            return found, step
        step = options.step or own_step(fmu)
        flanges = options.flange or ()
        found = check_flanges(
            make,
            role,
            step=step,
            flanges=flanges,
            longest=longest,
            progress=progress,
            content=started_content(fmu, values),
        )
        return found, step


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

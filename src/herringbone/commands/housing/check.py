"""What `herringbone check FMU --as housing` shows: the contract of housings, in one table."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from tqdm import tqdm

from herringbone.analysis.housing.behaviour import Finding
from herringbone.analysis.housing.contract import STEP, check_housing
from herringbone.commands.output import show
from herringbone.cosim.fmu.opening import open_fmu
from herringbone.housing import read_housing

_HEADER = ("test", "holds", "measured", "limit")


def check_command(fmu: Path, against: Path | None) -> int:
    """Show what holds, in one table; 1 if something does not.

    Args:
        fmu: the housing.
        against: modal data whose static compliance the housing must have, if any.

    Raises:
        HerringboneError: the FMU cannot be used, or does not step.
    """
    static = None if against is None else _static(against)
    with tqdm(disable=None, bar_format="[{elapsed}] {desc}") as bar:
        findings = check_housing(
            lambda: open_fmu("housing", fmu), static=static, progress=bar.set_description_str
        )
    failed = sum(not finding.holds for finding in findings)
    show(f"{fmu} as housing, steps of {1e6 * STEP:g} us:\n{_table(findings)}")
    show(f"{failed} test(s) fail" if failed else "all tests hold")
    return 1 if failed else 0


def _static(against: Path) -> np.ndarray:
    housing = read_housing(against)
    return housing.static_compliance() if housing.static is None else housing.static


def _table(findings: Sequence[Finding]) -> str:
    rows = [_HEADER]
    rows += [(f.test, "yes" if f.holds else "NO", f.measured, f.limit) for f in findings]
    widths = [max(len(row[k]) for row in rows) for k in range(len(_HEADER))]
    return "\n".join(
        "  " + "  ".join(cell.ljust(w) for cell, w in zip(row, widths, strict=True)).rstrip()
        for row in rows
    )

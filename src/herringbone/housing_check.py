"""Testing a housing FMU against the contract of housings: on demand, and before it runs."""

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from tqdm import tqdm

from herringbone.analysis.housing_behaviour import Finding
from herringbone.analysis.housing_contract import STEP, check_housing
from herringbone.core import HerringboneError
from herringbone.core.paths import cache_folder
from herringbone.cosim.open_fmu import open_fmu
from herringbone.housing import read_housing
from herringbone.output import show

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


def replacement_notes(fmu: Path) -> list[str]:
    """What a housing FMU that replaces the component does not hold; tested once per content.

    Wrong variables and units are left to the wiring, which refuses them.
    """
    try:
        digest = hashlib.sha256(fmu.read_bytes()).hexdigest()
    except OSError:
        return []
    known = cache_folder("housing-checks") / f"{digest}.json"
    if known.is_file():
        return json.loads(known.read_text(encoding="utf-8"))
    try:
        findings = check_housing(lambda: open_fmu("housing", fmu))
    except HerringboneError as error:
        return [f"{fmu} could not be tested as housing: {error}"]
    notes = [
        f"{fmu} breaks the contract of housings: {f.test}: {f.measured} (limit {f.limit}); see "
        f"'herringbone check {fmu} --as housing'"
        for f in findings
        if not f.holds
    ]
    known.write_text(json.dumps(notes), encoding="utf-8")
    return notes

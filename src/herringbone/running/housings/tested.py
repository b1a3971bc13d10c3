"""A housing FMU against the contract of housings: tested once for each content, and kept."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from herringbone.analysis.finding import Finding, Verdict
from herringbone.analysis.housing.contract import STEP, check_housing, repeats
from herringbone.core.caching.files import keep, kept
from herringbone.core.caching.keys import digest_of, kernels_key
from herringbone.core.caching.tried import tried_folder
from herringbone.core.part import Part
from herringbone.core.process.telling import Tell, untold
from herringbone.cosim.cell.policy import policy
from herringbone.cosim.fmu.opening import many_of
from herringbone.cosim.structure.system import Values
from herringbone.running.foreign.started import started, started_content

_FOLDER = "housings"
_SOURCES = (
    "herringbone.analysis.housing.contract",
    "herringbone.cosim.fmu.opening",
    "herringbone.running.foreign.started",
)


class Tested(NamedTuple):
    """What tests found.

    Attributes:
        findings: one a test.
        repeats: they would be the same another time.
    """

    findings: list[Finding]
    repeats: bool


def tested_housing(
    fmu: Path,
    usual: float,
    values: Values | None = None,
    *,
    static: np.ndarray | None = None,
    step: float = STEP,
    longest: int | None = None,
    progress: Tell = untold,
) -> Tested:
    """What tests of a housing find, now or before.

    Nothing is kept of one that does not repeat, or after a trial was lost.

    Args:
        fmu: the file.
        usual, static, step, longest, progress: see `check_housing`.
        values: start values by variable.

    Raises:
        HerringboneError: it does not start or does not step.
    """
    content = started_content(fmu, values or {})
    against = "" if static is None else digest_of("", np.ascontiguousarray(static).tobytes())
    asked = repr((f"{usual:.3g}", step, longest, against))
    file = tried_folder(_FOLDER) / f"{digest_of(kernels_key(*_SOURCES), *content, asked)}.json"
    if (known := kept(file)) is not None:
        return Tested([Finding(test, Verdict(v), *said) for test, v, *said in known], repeats=True)
    with many_of(fmu.stem, fmu) as new:
        make: Callable[[], Part] = started(new, values or {})
        found = check_housing(
            make, static=static, usual=usual, step=step, longest=longest, progress=progress
        )
        repeated = repeats(make, found, step)
    if repeated and not policy().lost[fmu.stem]:
        keep(file, [[f.test, f.verdict, f.measured, f.limit] for f in found])
    return Tested(found, repeated)

"""Communication step for masters that step all FMUs in parallel, on held inputs."""

import logging
from pathlib import Path

from herringbone.analysis.stability.steps.step_limits import step_limits
from herringbone.analysis.stability.steps.step_scan import LARGEST_STEP
from herringbone.core import HerringboneError
from herringbone.core.declaring.units import quantity
from herringbone.core.wording import option
from herringbone.cosim.algorithms import Jacobi
from herringbone.cosim.structure.system import System
from herringbone.running.known_limits import KnownLimits

PARALLEL = Jacobi(order=0, schedule="parallel")
"""What such masters do: elements answer one communication step late."""
SHARE = 1.0 / 3.0
"""Of the largest stable step."""
UNKNOWN = 2e-6
"""Step [s] where the largest stable one is not known, as with foreign FMUs."""
_log = logging.getLogger(__name__)


def told_late(reference: str | Path, system: System, step: float, *, changed: bool) -> str:
    """How to find what such masters err by a step [s]; "" where no part answers to another one.

    Args:
        reference: what was exported.
        system: the same, as it was exported.
        step: [s].
        changed: a scene, values, gears or housings were given.
    """
    if not system.connections:
        return ""
    same = ", with the scene, values, gears and housings of this export" if changed else ""
    error = "--verify" if system.foreign_parts else "--reference"
    return (
        f"communication step {quantity(step, 's')}: masters that step all parts in parallel see "
        f"elements one step late, and err in proportion to it: 'herringbone run {reference} "
        f"--algorithm jacobi:order=0,schedule=parallel --step {step:g} {error}'{same} tells by how "
        "much"
    )


def parallel_step(system: System) -> float:
    """A third of the largest stable step, rounded to one digit [s]; a line tells both.

    Args:
        system: at the start values of a scene.
    """
    try:
        limit = KnownLimits(system, UNKNOWN)(
            PARALLEL, False, lambda: step_limits(system, PARALLEL)
        ).limit
    except HerringboneError as error:
        _log.warning(
            "communication step %s: the largest stable one is not known (%s); choose it by %s",
            quantity(UNKNOWN, "s"),
            error,
            option("step"),
        )
        return UNKNOWN
    step = float(f"{SHARE * min(limit, LARGEST_STEP):.1g}")
    _log.info("communication step %s, stable below %s", quantity(step, "s"), quantity(limit, "s"))
    return step

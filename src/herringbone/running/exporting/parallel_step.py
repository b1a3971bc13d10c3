"""Communication step for masters that step all FMUs in parallel, on held inputs."""

import logging

from herringbone.analysis.stability.steps.step_limits import step_limits
from herringbone.analysis.stability.steps.step_scan import LARGEST_STEP
from herringbone.core import HerringboneError
from herringbone.core.declaring.units import quantity
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
            "communication step %s: the largest stable one is not known (%s); choose it by --step",
            quantity(UNKNOWN, "s"),
            error,
        )
        return UNKNOWN
    step = float(f"{SHARE * min(limit, LARGEST_STEP):.1g}")
    _log.info("communication step %s, stable below %s", quantity(step, "s"), quantity(limit, "s"))
    return step

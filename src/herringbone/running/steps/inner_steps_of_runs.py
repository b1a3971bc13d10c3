"""Inner steps of own parts in runs with ever shorter macro steps, of which one meets a tolerance.

Limits of a controller are kinks at a time inside of an inner step: its error falls with the second
power there (where teeth touch or part with the third, see `stability.recommendation`), that of the
coupling with the fourth. So inner steps fall with the square of the macro step, and runs tell by
one power what both err.
"""

from collections.abc import Mapping

from herringbone.analysis.stability.recommendation import separation_step
from herringbone.cosim.algorithms import LI
from herringbone.cosim.structure.system import System

SHARE = 0.1
"""Of the tolerance, for inner errors that no other run tells."""


def with_inner_steps_of(
    system: System, step: float, longest: float, tolerance: float, stable: Mapping[str, float]
) -> System:
    """The system with inner steps for one of the runs.

    They are not shorter than what errs a share of the tolerance by the rule, and one from node to
    node is the longest.

    Args:
        system: with all values.
        step: macro step [s].
        longest: that of the first run [s].
        tolerance: relative error that the last of the runs may have [1].
        stable: the longest that parts may take, see `inner_steps.stable_inner_steps`.
    """
    nodes = step / LI().degree
    inner = min(nodes, max(nodes * step / longest, separation_step(SHARE * tolerance)))
    return system.with_values({path: min(inner, most) for path, most in stable.items()})

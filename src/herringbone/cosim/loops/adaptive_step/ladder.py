"""The ladder of macro steps of an adaptive run, in whole ticks.

All times are whole numbers of one tick, so that they do not drift and the end is hit exactly. The
rungs lie a factor of 1.2 to 1.33 apart, and all but three divide the largest one, so that rows at
equal distances leave a choice: whole numbers of 1, 2, 3, 4, 5, 6, 8, 10 ... steps from row to row.
Parts and algorithm keep for each rung what depends on the step alone.
"""

import numpy as np

from herringbone.kernels.compiling.jit import kernel

RUNGS = (4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 40, 48, 60, 80, 96, 120, 160, 192, 240, 320, 400, 480,
         576, 720, 960)  # fmt: skip
"""Macro steps in ticks."""
TICKS = RUNGS[-1]
"""Ticks of the largest step."""
FIRST = (0.0, 0.2, 0.4, 1.0, 1.0)
"""Step with which a run begins that asks for FIRST_TOLERANCE, by degree, in largest steps: about
the one that will be used, so that its Jacobian serves."""
FIRST_TOLERANCE = 1e-3


@kernel
def _reachable(ticks: int) -> bool:
    """True if some rungs add up to so many ticks."""
    return ticks == 0 or (ticks >= 4 and ticks != 7)


@kernel
def dividing_rung(rungs: np.ndarray, wanted: int, left: int) -> int:
    """The largest rung up to `wanted` of which a whole number makes the rest, or else `wanted`.

    What has been taken of a row leaves a rest that is divided again.

    Args:
        rungs: steps in ticks, ascending.
        wanted: rung.
        left: ticks up to the next row.
    """
    for k in range(wanted, -1, -1):
        if left % rungs[k] == 0:
            return k
    return wanted


@kernel
def fitting_rung(rungs: np.ndarray, wanted: int, left: int) -> int:
    """The largest rung up to `wanted` after which the end can still be reached.

    Args:
        rungs: steps in ticks, ascending.
        wanted: rung.
        left: ticks up to the end; some rungs add up to it.
    """
    for k in range(wanted, -1, -1):
        if rungs[k] <= left and _reachable(left - rungs[k]):
            return k
    k = wanted
    while not (rungs[k] <= left and _reachable(left - rungs[k])):
        k += 1
    return k

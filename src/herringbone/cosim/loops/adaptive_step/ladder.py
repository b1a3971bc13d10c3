"""The ladder of macro steps of an adaptive run, in whole ticks.

All times are whole numbers of one tick, so that they do not drift and the end is hit exactly. The
rungs lie a factor of 1.2 to 1.33 apart (1 ... 200 in the series 1, 1.25, 1.6, 2, 2.5, 3.2, 4, 5,
6.4, 8, rounded to ticks); parts and algorithm keep for each rung what depends on the step alone.
"""

import numpy as np

from herringbone.kernels.compiling.jit import kernel

RUNGS = (4, 5, 6, 8, 10, 13, 16, 20, 25, 32, 40, 50, 64, 80, 100, 125, 160, 200, 250, 320, 400, 500,
         640, 800)  # fmt: skip
"""Macro steps in ticks."""
TICKS = RUNGS[-1]
"""Ticks of the largest step."""
FIRST = len(RUNGS) - 8
"""Rung with which a run begins that asks for FIRST_TOLERANCE: a fifth of the largest step."""
FIRST_TOLERANCE = 1e-4


@kernel
def _reachable(ticks: int) -> bool:
    """True if some rungs add up to so many ticks."""
    return ticks == 0 or (ticks >= 4 and ticks != 7)


@kernel
def dividing_rung(rungs: np.ndarray, wanted: int, left: int) -> int:
    """The largest rung up to `wanted` of which a whole number makes the rest, or else `wanted`.

    Two thirds of the rungs divide the largest one, and each that has been taken leaves a rest that
    is divided again.

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

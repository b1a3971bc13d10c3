"""Products of a step with the matrices of its rung, of the precision that these have.

Values and sums are in double precision always: nothing is rounded from step to step.
"""

import numpy as np

from herringbone.analysis.twin.condensed.rungs import Rungs
from herringbone.kernels.compiling.jit import inlined
from herringbone.kernels.condensed.modal import add_chosen, add_product


@inlined
def coordinates(rungs: Rungs) -> int:
    """Modal coordinates and angles."""
    return rungs.rows.shape[1] + rungs.short_rows.shape[1]


@inlined
def add_of_state(rungs: Rungs, rung: int, q: np.ndarray, to: np.ndarray) -> None:
    """Add what is wanted at the nodes, of the state at the start of a step."""
    short = rungs.short_rows.shape[1]
    if short == 0:
        add_product(rungs.rows[rung], q, to)
        return
    add_product(rungs.short_rows[rung], q[:short], to)  # and few angles, not worth a call
    for k in range(rungs.rows.shape[1]):
        angle, row = q[short + k], rungs.rows[rung, k]
        for i in range(to.size):
            to[i] += row[i] * angle


@inlined
def _add_of_rung(
    long: np.ndarray,
    short: np.ndarray,
    rung: int,
    v: np.ndarray,
    chosen: np.ndarray,
    count: int,
    to: np.ndarray,
) -> None:
    """Add by the short matrices, if there are any."""
    if len(short) > 0:
        add_chosen(short[rung], v, chosen, count, to)
    else:
        add_chosen(long[rung], v, chosen, count, to)


@inlined
def add_of_inputs(
    rungs: Rungs, rung: int, v: np.ndarray, chosen: np.ndarray, count: int, to: np.ndarray
) -> None:
    """Add the same of the first `count` chosen inputs."""
    _add_of_rung(rungs.of_inputs, rungs.short_of_inputs, rung, v, chosen, count, to)


@inlined
def add_push(
    rungs: Rungs, rung: int, v: np.ndarray, chosen: np.ndarray, count: int, q: np.ndarray
) -> None:
    """Add what the first `count` chosen inputs do to the state at the end."""
    _add_of_rung(rungs.push, rungs.short_push, rung, v, chosen, count, q)
    if len(rungs.still) > 0:
        still = rungs.still[rung]
        for k in range(q.size):
            q[k] += still[k]

"""What the adaptive loop works on, beside layout, nodes and buffers."""

from typing import NamedTuple

import numpy as np

(WANTED, USED, ACCEPTED, ROWS, CULPRIT, BEFORE, BEFORE_THAT, MISSED, MISSED_NOW,
 TAKEN_BACK) = range(10)  # fmt: skip
"""Places in `Adaptive.state`."""
NONE, NEEDED, SCALED, OWN = range(4)
"""Where a rung's correction stands: none yet; a Jacobian of its own is wanted; derived from other
rungs; from a Jacobian of its own."""


class Adaptive(NamedTuple):
    """Step control and its memory.

    Attributes:
        tolerance: relative error that is asked for.
        last: ticks of the whole run.
        rungs: macro steps in ticks, ascending.
        corrections: (rungs, unknowns p, unknowns p).
        ready: NONE ... OWN by rung.
        owed: corrections beyond the first, by rung, since its Jacobian.
        taken, rejected: macro steps by rung.
        held: 1 for unknowns that a body holds over a step.
        squares: room for one number per group.
        moments: of the forces, see `step_error.update_scale`.
        covered: (1,) time that they cover [s].
        sharpness: (1,) largest error over ticks^order of the last steps.
        state: rung wanted; rung in use; macro steps accepted; rows recorded; unknown that errs
            most; lengths of the last two macro steps in ticks; steps that erred too much and could
            not be smaller, in all and in a row; 1 after a step that was taken back.
        times: of the rows [s].
    """

    tolerance: float
    last: int
    rungs: np.ndarray
    corrections: np.ndarray
    ready: np.ndarray
    owed: np.ndarray
    taken: np.ndarray
    rejected: np.ndarray
    held: np.ndarray
    squares: np.ndarray
    moments: np.ndarray
    covered: np.ndarray
    sharpness: np.ndarray
    state: np.ndarray
    times: np.ndarray

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
        squares: (2, groups): of the errors of coupling and inner steps in the present step.
        errors: (2, groups): the integrals of these over time.
        far: (1,) error of the run so far.
        moments, covered: of the forces, and times: see `step_error.update_scale`.
        memory: over which the forces' mean is taken [s].
        inner_step: longest of the bodies [s]; 0 if they make none.
        sharpness: (1,) largest error over ticks^order of the last steps.
        state: rung wanted; rung in use; macro steps accepted; rows recorded; unknown that errs
            most; lengths of the last two macro steps in ticks; steps that erred too much and could
            not be smaller, in all and in a row; 1 after a step that was taken back.
        before: (p + 1, unknowns): values at the nodes of the last step.
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
    errors: np.ndarray
    far: np.ndarray
    moments: np.ndarray
    covered: np.ndarray
    memory: float
    inner_step: float
    sharpness: np.ndarray
    state: np.ndarray
    before: np.ndarray
    times: np.ndarray

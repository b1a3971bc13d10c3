"""What the adaptive loop works on, beside layout, nodes and buffers."""

from typing import NamedTuple

import numpy as np

from herringbone.cosim.layouts.inner_stepping import Lengthened
from herringbone.cosim.layouts.measured import Measured
from herringbone.cosim.layouts.nodes import NodeLayout

(WANTED, USED, ACCEPTED, ROWS, CULPRIT, BEFORE, BEFORE_THAT, MISSED, MISSED_NOW,
 TAKEN_BACK) = range(10)  # fmt: skip
"""Places in `Adaptive.state`: rung wanted; rung in use; macro steps accepted; rows recorded;
unknown that errs most; lengths of the last two macro steps in ticks; steps that erred too much and
could not be smaller, in all and in a row; 1 after a step that was taken back."""
NONE, NEEDED, SCALED, OWN = range(4)
"""Where a rung's correction stands: none yet; a Jacobian of its own is wanted; derived from other
rungs; from a Jacobian of its own."""


class Adaptive(NamedTuple):
    """Step control and its memory.

    Attributes:
        tolerance: relative error that is asked for.
        last: ticks of the whole run.
        rungs: macro steps in ticks, ascending.
        corrections: (rungs, unknowns p, unknowns p), each by columns.
        ready: NONE ... OWN by rung.
        owed: corrections beyond the first, by rung, since its Jacobian.
        taken, rejected: macro steps by rung.
        measured: signals by whose errors a step is measured, and groups of them.
        squares: (2, groups): of the errors of coupling and inner steps in the present step.
        errors: (2, groups): the integrals of these over time.
        far: (1,) error of the run so far.
        moments, covered: of the signals, and times: see `step_error.update_sizes`.
        room: see `step_error.room_for`.
        memory: time over which signals are taken about a straight line [s].
        aim, held: see `step_choice.AIM`.
        inner: steps of the bodies.
        error: (2,) of the present step by coupling and inner steps.
        sharpness: (2,) these over their powers of ticks, of the last steps.
        counts: (2,) these by which the next step is chosen.
        ones: (2,) 1.
        state: (10,), see `WANTED`.
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
    measured: Measured
    squares: np.ndarray
    errors: np.ndarray
    far: np.ndarray
    moments: np.ndarray
    covered: np.ndarray
    room: np.ndarray
    memory: float
    aim: float
    held: float
    inner: Lengthened
    error: np.ndarray
    sharpness: np.ndarray
    counts: np.ndarray
    ones: np.ndarray
    state: np.ndarray
    before: np.ndarray
    times: np.ndarray


def new_adaptive(
    nodes: NodeLayout,
    rungs: np.ndarray,
    *,
    measured: Measured,
    tolerance: float,
    last: int,
    memory: float,
    aim: float,
    held: float,
    inner: Lengthened,
    times: np.ndarray,
    room: np.ndarray,
) -> Adaptive:
    """Step control of a run that has not begun.

    Args:
        nodes: the layout of passes.
        rungs, measured, tolerance, last, memory, aim, held, inner, times, room: see `Adaptive`.
    """
    unknowns, groups = nodes.unknown.size, measured.members.size
    size = nodes.degree * unknowns
    return Adaptive(
        tolerance=tolerance,
        last=last,
        rungs=rungs,
        corrections=np.zeros((rungs.size, size, size)),
        ready=np.full(rungs.size, NONE, dtype=np.int64),
        owed=np.zeros(rungs.size, dtype=np.int64),
        taken=np.zeros(rungs.size, dtype=np.int64),
        rejected=np.zeros(rungs.size, dtype=np.int64),
        measured=measured,
        squares=np.zeros((2, groups)),
        errors=np.zeros((2, groups)),
        far=np.zeros(1),
        moments=np.zeros((5, max(measured.output.size, groups))),
        covered=np.zeros(4),
        room=room,
        memory=memory,
        aim=aim,
        held=held,
        inner=inner,
        error=np.zeros(2),
        sharpness=np.zeros(2),
        counts=np.zeros(2),
        ones=np.ones(2),
        state=np.zeros(TAKEN_BACK + 1, dtype=np.int64),
        before=np.zeros((nodes.degree + 1, unknowns)),
        times=times,
    )

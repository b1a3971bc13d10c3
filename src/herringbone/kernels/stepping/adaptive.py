"""Communication steps that follow a tolerance: leaps, and classical Runge-Kutta beside them.

No inner step is longer than the longest one that the caller keeps in the block: beyond the
stability limit, 2.8 over the largest eigenvalue (Hairer and Wanner, Solving Ordinary Differential
Equations II, 1996, section IV.2), an error is seen only when it has grown.
"""

from collections.abc import Callable

import numpy as np

from herringbone.core.declaring.declaration import Declaration
from herringbone.kernels.compiling.jit import inner
from herringbone.kernels.signals import STRIDE, all_finite, store_node
from herringbone.kernels.steppers import NOT_FINITE, TOO_LONG, Out, Rhs, input_kernels
from herringbone.kernels.stepping.explicit import NEARER, explicit_stepper
from herringbone.kernels.stepping.leaping import ANEW, AT_ONCE, LATER, SAME, Leaps, no_leaps
from herringbone.kernels.stepping.local_error import Slots

FIRST, LARGEST = 2.5e-6, 1e-4
"""Inner steps [s]: the first, the largest."""
LONGEST_STEP = 10.0
"""Longest communication step [s] of one call: about a million inner steps."""
_SHARE = 0.04
"""Of the tolerance that a step beside leaps may take.

Of an oscillation with z = rate times step the estimate is z^4 / 120, and rates are wrong by as much
of them. So what is forced at resonance errs the estimate over the damping ratio, and what is free
the estimate times the phase since its start. Housings have ratios of 0.01: 4 times the tolerance,
if one such mode were all that moves. The worst one of speeds, torques and pairs that were drawn
errs a quarter of that at 1e-8, where there are no leaps (`campaigns.condensed_steps`).

At knots of tables errors are 0.23 of the estimate in the mean, of either sign, and add up to 0.23
times the root of their number n until vibrations have decayed: 0.3 of the tolerance for n = 1000,
which a pair that rattles on rigid ground meets in the 6 ms of its decay at a tolerance of 1e-8."""


def adaptive_work(state_count: int, input_count: int) -> int:
    """Length of the work space that the stepper needs."""
    return Slots.of(state_count).known + 1 + (STRIDE + 1) * input_count


def _interval_stepper(
    declaration: Declaration, explicit: Callable, leaps: Leaps, shortest: float
) -> Callable:
    """Compile interval(b, w, t, h, begin, end, tolerance, degree, can_leap) -> int."""
    known = Slots.of(declaration.state_count).known
    leap, forget = leaps.leap, leaps.forget
    room, closer = shortest * (1.0 - SAME), NEARER * shortest

    @inner(declaration.name)
    def interval(
        b: np.ndarray, w: np.ndarray, t: float, h: float, begin: float, end: float,
        tolerance: float, degree: int, can_leap: bool,
    ) -> int:  # fmt: skip
        """As `explicit`, with leaps where they can be taken."""
        done = begin
        while done < end:
            reached = done
            if can_leap:
                reached = leap(b, w, t, h, done, end, tolerance, degree)
                w[known] = 0.0  # its laws were called elsewhere
            done = reached + shortest
            if end - done < shortest * SAME or tolerance == np.inf:  # rounding makes no step
                done = end
            if reached < done:
                forget(b, w)
                # room for a leap: a law bends, and may do so twice between the ends of a long step
                most = closer if can_leap and end - reached >= room else LARGEST
                status = explicit(b, w, t, h, reached, done, tolerance, degree, most)
                if status != 0:
                    return status
        return 0

    return interval


def adaptive_stepper(
    rhs: Rhs,
    out: Out,
    declaration: Declaration,
    next_step: str,
    longest_step: Callable[[np.ndarray, np.ndarray], float],
    core: Callable[[Callable], Leaps] | None = None,
    shortest: float = np.inf,
    *,
    later: bool = False,
) -> Callable[[np.ndarray, np.ndarray, float, float, float, int], int]:
    """Compile the step of a body; inputs and outputs as in `steppers.body_stepper`.

    Args:
        rhs, out: kernels.
        declaration: of the component.
        next_step: name of the local that keeps the length of the next inner step [s].
        longest_step: kernel (b, w): no inner step is longer [s].
        core: makes, of the kernel that sets inputs, those that leap ahead.
        shortest: length of its steps that ends where it stops [s].
        later: outputs of a leap are made when they are asked for, where inputs have no nodes.

    Returns:
        step(b, w, t, h, tolerance, degree) -> int: block, work space (`adaptive_work` long), start
        and length of the macro step [s] (h >= 0), tolerance, interface degree; 0, NOT_FINITE,
        TOO_LONG or, of `explicit`, TOO_SMALL. With a tolerance of infinity all inner steps are as
        long as the longest one, which `next_step` has to be then, but for what makes them equal.
    """
    n, known = declaration.state_count, Slots.of(declaration.state_count).known
    first_output, outputs = declaration.first_output, len(declaration.node_outputs)
    expand_inputs, set_inputs, restore_inputs = input_kernels(declaration, known + 1)
    following = declaration.index[next_step]
    leaps = core(set_inputs) if core else no_leaps(out, declaration.name)
    explicit = explicit_stepper(
        rhs, declaration, following, longest_step, set_inputs, leaps.bent, _SHARE if core else 1.0
    )
    interval = _interval_stepper(declaration, explicit, leaps, shortest)
    ready, show = leaps.ready, leaps.show
    kept, kept_count = (declaration.first_kept, declaration.kept) if later else (0, 0)

    @inner(declaration.name)
    def step(
        b: np.ndarray, w: np.ndarray, t: float, h: float, tolerance: float, degree: int
    ) -> int:
        if not h <= LONGEST_STEP:
            return TOO_LONG
        can_leap = ready(b, w, t) and tolerance < np.inf
        expand_inputs(b, w, degree)
        intervals = max(degree, 1)
        status, begin, made = 0, 0.0, True
        how = AT_ONCE if h > 0.0 else ANEW
        if later and degree == 0 and h > 0.0:
            how = LATER
        w[known] = 0.0
        for node in range(1, intervals + 1):
            end = h if node == intervals else h * node / intervals
            if status == 0 and end > begin:
                status = interval(b, w, t, h, begin, end, tolerance, degree, can_leap)
            begin = end
            set_inputs(b, w, degree, node / intervals)
            made = show(b, w, t + end, how)
            if made:
                store_node(b, first_output, outputs, node)
        restore_inputs(b, w, degree)
        if status == 0:
            sound = all_finite(b, 0, n) if made else all_finite(b, kept, kept_count)
            status = 0 if sound else NOT_FINITE
        return status

    return step

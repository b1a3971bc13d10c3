"""Periodic motion of a body whose forces change with an angle that turns evenly.

Harmonic balance, with the forces sampled in time (T. M. Cameron and J. H. Griffin, J. Appl. Mech.
56, 1989, 149-154): where the accelerations that the equations give differ from those of the motion
assumed so far, each harmonic of the difference is answered by the linear equations, with stiffness
and damping averaged over the period. What does not return after a period, such as a run-out, whose
period is a whole turn, is told from the rest by its mean over a period around each instant, and is
followed without inertia; its harmonics of one turn of either gear are answered like the others.

The search begins with all coordinates at rest. Angles turn with the rates that they have there.
"""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import inner
from herringbone.kernels.elementary import sine_and_cosine
from herringbone.kernels.periodic.harmonics import SAMPLES
from herringbone.kernels.periodic.linear_answer import linear_answer
from herringbone.kernels.periodic.once_a_turn import answer_to_turns
from herringbone.kernels.periodic.places import Body, places_from
from herringbone.kernels.periodic.sampled import sampling
from herringbone.kernels.steppers import Rhs
from herringbone.kernels.stepping.newton import NOT_FOUND, SETTLED

_ROUNDS, _CLOSE = 4, 0.02
"""Most corrections; difference of the accelerations at the end, over that in the beginning."""
_NOTHING = 1e-6
"""Difference that counts as none, over what a usual displacement gives."""
_NONE = 1e-4
"""Part of that difference below which a harmonic is left out."""
_TURN = 6.283185307179586


def periodic_motion(
    rhs: Rhs, body: Body, scratch: int, owner: str
) -> Callable[[np.ndarray, float, tuple[float, float]], int]:
    """Compile the search for a periodic motion.

    Args:
        rhs: kernel.
        body: whose motion it is.
        scratch: index in the block of `places.periodic_scratch` numbers.
        owner: name of the component, for messages.

    Returns:
        search(b, period, turns) -> int: SETTLED, with the states of time 0; or NOT_FOUND, with the
        states as they were. `period` is in seconds, `turns` how many of them a turn of either gear
        has; time is 0 in the middle of the samples.
    """
    at = places_from(scratch, body.states, len(body.xs))
    turned, accelerate, average, sample = sampling(rhs, body, at, owner)
    follow, vibrate, correct = linear_answer(body, at, owner)
    answer = answer_to_turns(turned, accelerate, follow, vibrate, body, at, owner)
    xs, vs, sizes, _, _, n = body
    m, dx_at, kept_at, k_at = len(xs), at.dx, at.kept, at.k
    motion_at, drift_at, x_at, found_at = at.motion, at.drift, at.x, at.found
    table_at, end = at.table, at.end

    @inner(owner)
    def search(b: np.ndarray, period: float, turns_of: tuple[float, float]) -> int:
        for k in range(SAMPLES):
            s, c = sine_and_cosine(_TURN * k / SAMPLES)
            b[table_at + k], b[table_at + SAMPLES + k] = c, s
        for i in range(3 * SAMPLES * m):
            b[motion_at + i] = 0.0
        for i in range(n):
            b[kept_at + i] = b[i]
        rhs(b, 0.0, b[dx_at:kept_at])
        average(b, period)
        enough = 0.0
        for i in range(m):
            enough = max(enough, _NOTHING * sizes[i] * abs(b[k_at + i * m + i]))
        largest, rounds = sample(b, period), 0
        none = _NONE * largest
        enough = max(enough, _CLOSE * largest)
        while largest > enough and rounds < _ROUNDS:
            correct(b, period, none)
            largest = sample(b, period)
            rounds += 1
        turned(b, 0.0)
        if not largest <= enough:
            return NOT_FOUND
        follow(b, b[drift_at:x_at])
        for i in range(m):
            b[drift_at + i] = b[found_at + i] / period
        gears = answer(b, period, turns_of)
        turned(b, 0.0)
        for i in range(m):
            b[xs[i]] += b[motion_at + i]
            b[vs[i]] += b[motion_at + SAMPLES * m + i] + b[drift_at + i]
            for gear in range(gears):
                b[xs[i]] += b[end + 2 * gear * m + i]
                b[vs[i]] += b[end + (2 * gear + 1) * m + i]
        return SETTLED

    return search

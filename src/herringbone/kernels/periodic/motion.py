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
from herringbone.kernels.periodic.complex_solve import complex_solve
from herringbone.kernels.periodic.harmonics import (
    HALF,
    SAMPLES,
    WINDOW,
    add_harmonic,
    harmonic,
    split,
)
from herringbone.kernels.periodic.once_a_turn import MotionPlaces, answer_to_turns
from herringbone.kernels.periodic.turns import turns_scratch
from herringbone.kernels.steppers import Rhs
from herringbone.kernels.stepping.newton import NOT_FOUND, SETTLED, solve

_PHASES, _DIFFERENCE = 8, 1e-3
"""Phases over which stiffness and damping are averaged; displacement over the usual size."""
_ROUNDS, _CLOSE = 4, 0.02
"""Most corrections; difference of the accelerations at the end, over that in the beginning."""
_NOTHING = 1e-6
"""Difference that counts as none, over what a usual displacement gives."""
_NONE = 1e-4
"""Part of that difference below which a harmonic is left out."""
_SLOWEST = 100.0
"""Least angular frequency [rad/s] with which a displacement makes that of its rate."""
_TURN = 6.283185307179586


def periodic_scratch(states: int, coordinates: int) -> int:
    """Length of the scratch space for so many states and coordinates."""
    m = coordinates
    fixed = 2 * states + 4 * m * m + (3 * SAMPLES + WINDOW + 6) * m + 2 * SAMPLES
    return fixed + turns_scratch(m)


def periodic_motion(  # noqa: PLR0915 (kernels that share their layout)
    rhs: Rhs,
    coordinates: tuple[tuple[int, int], ...],
    sizes: tuple[float, ...],
    turning: tuple[int, ...],
    free: int,
    states: int,
    scratch: int,
    owner: str,
) -> Callable[[np.ndarray, float, tuple[float, float]], int]:
    """Compile the search for a periodic motion.

    Args:
        rhs: kernel.
        coordinates: places of each coordinate and of its rate among the states.
        sizes: usual sizes of the coordinates.
        turning: states that are angles which turn evenly, besides what they do as coordinates.
        free: the coordinate whose mean is free; -1: none.
        states: number of states, which come first in the block.
        scratch: index in the block of `periodic_scratch` numbers.
        owner: name of the component, for messages.

    Returns:
        search(b, period, turns) -> int: SETTLED, with the states of time 0; or NOT_FOUND, with the
        states as they were. `period` is in seconds, `turns` how many of them a turn of either gear
        has; time is 0 in the middle of the samples.
    """
    n, m, turns = states, len(coordinates), len(turning)
    xs, vs = tuple(x for x, _ in coordinates), tuple(v for _, v in coordinates)
    dx_at, kept_at = scratch, scratch + n
    k_at = kept_at + n
    c_at, re_at, im_at = k_at + m * m, k_at + 2 * m * m, k_at + 3 * m * m
    motion_at = k_at + 4 * m * m
    g_at = motion_at + 3 * SAMPLES * m
    mean_at = g_at + WINDOW * m
    drift_at, x_at, y_at, order_at, found_at, table_at = (mean_at + k * m for k in range(1, 7))
    end = table_at + 2 * SAMPLES

    @inner(owner)
    def turned(b: np.ndarray, t: float) -> None:
        """The states in which the search begins, at another time."""
        for i in range(n):
            b[i] = b[kept_at + i]
        for k in range(turns):
            b[turning[k]] += b[dx_at + turning[k]] * t

    @inner(owner)
    def accelerate(b: np.ndarray, t: float, r: np.ndarray) -> None:
        dx = b[dx_at:kept_at]
        for k in range(turns):
            r[k] = dx[turning[k]]
        rhs(b, t, dx)
        for k in range(turns):
            dx[turning[k]] = r[k]
        for i in range(m):
            r[i] = dx[vs[i]]

    @inner(owner)
    def average(b: np.ndarray, period: float) -> None:
        """Stiffness and damping: what rates change by, per coordinate and per rate."""
        base, moved = b[mean_at:drift_at], b[drift_at:x_at]
        for i in range(2 * m * m):
            b[k_at + i] = 0.0
        for phase in range(_PHASES):
            t = period * phase / _PHASES
            turned(b, t)
            accelerate(b, t, base)
            for j in range(m):
                for order in range(2):
                    at, size = xs[j], _DIFFERENCE * sizes[j]
                    if order == 1:
                        at, size = vs[j], size * max(_TURN / period, _SLOWEST)
                    before = b[at]
                    b[at] = before + size
                    accelerate(b, t, moved)
                    b[at] = before
                    for i in range(m):
                        to = k_at + order * m * m + i * m + j
                        b[to] -= (moved[i] - base[i]) / (size * _PHASES)

    @inner(owner)
    def sample(b: np.ndarray, period: float) -> float:
        """Accelerations over two periods less those of the motion; see `split`."""
        for k in range(WINDOW):
            t = period * (k - SAMPLES) / SAMPLES
            turned(b, t)
            motion = b[motion_at + (k % SAMPLES) * m : g_at]
            for i in range(m):
                b[xs[i]] += motion[i]
                b[vs[i]] += motion[SAMPLES * m + i]
            row = b[g_at + k * m : g_at + (k + 1) * m]
            accelerate(b, t, row)
            for i in range(m):
                row[i] -= motion[2 * SAMPLES * m + i]
        return split(b[g_at:mean_at], b[mean_at:drift_at], b[drift_at:x_at], m)

    @inner(owner)
    def follow(b: np.ndarray, r: np.ndarray) -> None:
        """Displacements (m,) under slow forces; the free coordinate stays."""
        a, x = b[re_at:im_at], b[x_at:y_at]
        for i in range(m):
            x[i] = r[i]
            for j in range(m):
                a[i * m + j] = b[k_at + i * m + j]
        if free >= 0:
            x[free] = 0.0
            for i in range(m):
                a[free * m + i], a[i * m + free] = 0.0, 0.0
        solve(a, x, b[order_at:found_at], b[found_at:table_at], m)

    @inner(owner)
    def vibrate(b: np.ndarray, w: float) -> None:
        """Make the linear equations of a harmonic, K - w^2 + i w C; w: [rad/s]."""
        for i in range(m * m):
            b[re_at + i], b[im_at + i] = b[k_at + i], w * b[c_at + i]
        for i in range(m):
            b[re_at + i * m + i] -= w * w

    @inner(owner)
    def correct(b: np.ndarray, period: float, none: float) -> None:
        g, table, motion = b[g_at:mean_at], b[table_at:end], b[motion_at:g_at]
        x, y = b[x_at:y_at], b[y_at:order_at]
        follow(b, b[mean_at:drift_at])
        for k in range(SAMPLES):
            for i in range(m):
                motion[k * m + i] += b[found_at + i]
        for h in range(1, HALF):
            if harmonic(g, h, table, x, y, m) > none:
                w = h * _TURN / period
                vibrate(b, w)
                complex_solve(b[re_at:im_at], b[im_at:motion_at], x, y, m)
                add_harmonic(x, y, h, w, table, motion, m)

    at = MotionPlaces(
        c_at, re_at, im_at, motion_at, g_at, mean_at, drift_at, x_at, y_at, order_at,
        found_at, end,
    )  # fmt: skip
    answer = answer_to_turns(turned, accelerate, follow, vibrate, xs, vs, free, at, owner)

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

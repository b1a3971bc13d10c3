"""What inertia and damping add to the answer of a body to what returns with the turns of gears."""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import inner
from herringbone.kernels.periodic.complex_solve import complex_solve
from herringbone.kernels.periodic.harmonics import SAMPLES
from herringbone.kernels.periodic.places import Body, Places
from herringbone.kernels.periodic.turns import INSTANTS, fit_turns, instant, turns_scratch

PHASES = 8
"""Of a mesh period, over which what changes slowly is averaged."""
_TURN = 6.283185307179586


def answer_to_turns(
    turned: Callable,
    accelerate: Callable,
    follow: Callable,
    vibrate: Callable,
    body: Body,
    at: Places,
    owner: str,
) -> Callable[[np.ndarray, float, tuple[float, float]], int]:
    """Compile answer(b, period, turns) -> int, when the motion of a mesh period is found.

    Args:
        turned, accelerate, follow, vibrate: kernels, see `sampled` and `linear_answer`.
        body: whose motion it is; its free coordinate is not moved.
        at: places.
        owner: name of the component, for messages.

    Returns:
        The kernel; it returns for how many gears there is, from `at.end` on, what is added at time
        0 to coordinates (m,) and rates (m,).
    """
    m = len(body.xs)
    slow = _slow_fitter(turned, accelerate, body, at, owner)
    swing = _swing_adder(follow, vibrate, body, at, owner)

    @inner(owner)
    def answer(b: np.ndarray, period: float, turns_of: tuple[float, float]) -> int:
        gears = slow(b, period, turns_of)
        swing(b, at.end, _TURN / (period * turns_of[0]))
        if gears > 1:
            swing(b, at.end + 2 * m, _TURN / (period * turns_of[1]))
        return gears

    return answer


def _slow_fitter(
    turned: Callable, accelerate: Callable, body: Body, at: Places, owner: str
) -> Callable[[np.ndarray, float, tuple[float, float]], int]:
    """Compile slow(b, period, turns) -> int: of how many gears there are harmonics."""
    xs, vs, m, scratch = body.xs, body.vs, len(body.xs), turns_scratch(len(body.xs))

    @inner(owner)
    def slow(b: np.ndarray, period: float, turns_of: tuple[float, float]) -> int:
        """Fit what is left of the accelerations while the gears turn; see `fit_turns`."""
        dx = b[at.x : at.y]
        for k in range(INSTANTS):
            row = b[at.g + k * m : at.g + (k + 1) * m]
            for i in range(m):
                row[i] = 0.0
            for phase in range(PHASES + 1):
                t = period * (instant(k, turns_of) + phase / PHASES - 0.5)
                turned(b, t)
                row_of = (phase + PHASES // 2) % PHASES * (SAMPLES // PHASES)
                motion = b[at.motion + row_of * m : at.g]
                for i in range(m):
                    b[xs[i]] += motion[i]
                    b[vs[i]] += motion[SAMPLES * m + i]
                accelerate(b, t, dx)
                share = (0.5 if phase % PHASES == 0 else 1.0) / PHASES
                for i in range(m):
                    row[i] += share * (dx[i] - motion[2 * SAMPLES * m + i])
        return fit_turns(b[at.g : at.mean], turns_of, m, b[at.end : at.end + scratch])

    return slow


def _swing_adder(
    follow: Callable, vibrate: Callable, body: Body, at: Places, owner: str
) -> Callable[[np.ndarray, int, float], None]:
    """Compile swing(b, begin, w)."""
    m, free = len(body.xs), body.free

    @inner(owner)
    def swing(b: np.ndarray, begin: int, w: float) -> None:
        """What inertia and damping add to the answer to a harmonic that begins there; w: [rad/s].

        It is that of K x = c, less its own inertia and damping.
        """
        re, im, x, y = (
            b[at.re : at.im],
            b[at.im : at.motion],
            b[at.y : at.order],
            b[at.mean : at.drift],
        )
        follow(b, b[begin : begin + m])
        for i in range(m):
            x[i] = b[at.found + i]
        follow(b, b[begin + m : begin + 2 * m])
        for i in range(m):
            p, q = w * w * x[i], w * w * b[at.found + i]
            for j in range(m):
                c = w * b[at.c + i * m + j]
                p, q = p + c * b[at.found + j], q - c * x[j]
            b[begin + i], b[begin + m + i] = p, q
        vibrate(b, w)
        for i in range(m):
            x[i], y[i] = b[begin + i], b[begin + m + i]
        if free >= 0:
            x[free], y[free] = 0.0, 0.0
            for i in range(m):
                re[free * m + i], im[free * m + i] = 0.0, 0.0
            re[free * m + free] = 1.0
        complex_solve(re, im, x, y, m)
        for i in range(m):
            b[begin + i], b[begin + m + i] = x[i], -w * y[i]

    return swing

"""Inner steps of classical Runge-Kutta that follow a tolerance.

The derivative at the end of a step is that at the start of the next one, so that an embedded
formula of order 3 costs nothing: with the stages k1 ... k4 and k5 = f(x(t + h)), the weights
(1/6, 1/3, 1/3, 1/15, 1/10) fulfil its conditions (E. Hairer, S. P. Norsett, G. Wanner, Solving
Ordinary Differential Equations I, 1993, section II.4); the estimate is h (k4 - k5) / 10. What it
does not see of laws is in `local_error`.

A step that has none before, the first one after a communication point or a leap, cannot be compared
with it. Its whole second difference counts then. If that is too much, the next step shows a knot in
it: seen backwards in time, that one is the step before. So the first one is taken for as long as
the embedded formula allows, the second one is no longer, and if that one errs, both are taken
again. Where it would reach the end of the communication step, it is made shorter: one follows then.
"""

import math
from collections.abc import Callable

import numpy as np

from herringbone.core.declaring.declaration import Declaration
from herringbone.kernels.compiling.jit import inner
from herringbone.kernels.steppers import Rhs
from herringbone.kernels.stepping.local_error import Slots, error_measure, factor

TOO_SMALL = 3
"""Status of a step in which the tolerance asked for inner steps that are too small."""
_SMALLEST, _BY_TOLERANCE = 1e-10, 1e-3
"""Length of the smallest inner step [s]; at small tolerances, over these: what teeth that meet ask
for is smaller then."""
_MOST, _MEAN = 20_000, 1e-8
"""Steps between two ends, and their mean length [s] where there are more: fewer and longer ones do
for any gearbox, not for what has grown until it is none any more."""
_BENT = 6.0
"""Of the longest step, and the root of the tolerance: steps in which a law bends, unseen by the
estimate; what a step errs there grows with the square of its length."""
NEARER = 0.25
"""Of a step in which a law bends, that is longer: the next one, from the same start."""


def _runge_kutta(
    rhs: Rhs, declaration: Declaration, slots: Slots, set_inputs: Callable
) -> Callable:
    """Compile runge_kutta(b, w, ts, hs, degree, c, dc), between c and c + dc of the macro step."""
    n, x0, slope, first, last = declaration.state_count, *slots[:4]

    @inner(declaration.name)
    def runge_kutta(
        b: np.ndarray, w: np.ndarray, ts: float, hs: float, degree: int, c: float, dc: float
    ) -> None:
        """One inner step, with the derivatives at its start given and those at its end found."""
        dx = w[:n]
        for i in range(n):
            w[x0 + i] = b[i]
            w[slope + i] = w[first + i]
            b[i] = w[x0 + i] + 0.5 * hs * w[first + i]
        set_inputs(b, w, degree, c + 0.5 * dc)
        rhs(b, ts + 0.5 * hs, dx)
        for i in range(n):
            w[slope + i] += 2.0 * dx[i]
            b[i] = w[x0 + i] + 0.5 * hs * dx[i]
        rhs(b, ts + 0.5 * hs, dx)
        for i in range(n):
            w[slope + i] += 2.0 * dx[i]
            b[i] = w[x0 + i] + hs * dx[i]
        set_inputs(b, w, degree, c + dc)
        rhs(b, ts + hs, dx)
        for i in range(n):
            w[last + i] = dx[i]
            b[i] = w[x0 + i] + hs / 6.0 * (w[slope + i] + dx[i])
        rhs(b, ts + hs, dx)

    return runge_kutta


def _enterer(
    rhs: Rhs, declaration: Declaration, slots: Slots, set_inputs: Callable, go_on: Callable
) -> Callable:
    """Compile enter(b, w, t, h, begin, degree), before the first step from t + begin on."""
    n, start, known = declaration.state_count, slots.start, slots.known

    @inner(declaration.name)
    def enter(b: np.ndarray, w: np.ndarray, t: float, h: float, begin: float, degree: int) -> None:
        """Find the rates at the start, if they are not known: no step lies before."""
        if w[known] == 0.0:
            set_inputs(b, w, degree, begin / h)
            rhs(b, t + begin, w[:n])
            go_on(w, 0.0, False)
            w[known] = 1.0
            for i in range(n):
                w[start + i] = b[i]

    return enter


def explicit_stepper(
    rhs: Rhs,
    declaration: Declaration,
    following: int,
    longest_step: Callable,
    set_inputs: Callable,
    bent: Callable,
    share: float,
) -> Callable:
    """Compile explicit(b, w, t, h, begin, end, tolerance, degree, most) -> int.

    `following` is the place of the length of the next inner step [s].
    """
    n, slots = declaration.state_count, Slots.of(declaration.state_count)
    x0, start, length, known = slots.x0, slots.start, slots.length, slots.known
    error_of, go_on = error_measure(declaration, slots)
    runge_kutta = _runge_kutta(rhs, declaration, slots, set_inputs)
    enter = _enterer(rhs, declaration, slots, set_inputs, go_on)

    @inner(declaration.name)
    def explicit(
        b: np.ndarray, w: np.ndarray, t: float, h: float, begin: float, end: float,
        tolerance: float, degree: int, most: float,
    ) -> int:  # fmt: skip
        """Integrate from t + begin to t + end, inside the macro step, in steps up to `most` [s]."""
        done, row, follows, doubtful = begin, 0, tolerance < np.inf, False
        within = share * tolerance
        smallest = min(_SMALLEST, _BY_TOLERANCE * tolerance)
        left_over = _MOST + (end - begin) / _MEAN
        while done < end:
            if done == begin:
                enter(b, w, t, h, begin, degree)
                if follows:
                    bent(b, w, t + begin, row)
            left, judged, hides = end - done, doubtful, False
            left_over -= 1.0
            if follows and left_over < 0.0:
                return TOO_SMALL
            count = max(1.0, math.ceil(left / min(b[following], most) - 1e-9))
            hs = left / count
            runge_kutta(b, w, t + done, hs, degree, done / h, hs / h)
            error = error_of(b, w, hs, True) / within if follows else 0.0
            ahead = hs * factor(error)
            if error > 1.0 and count > 1.0 and w[length] == 0.0:  # the next one judges it
                error, hides = error_of(b, w, hs, False) / within, True
                ahead = hs if error <= 1.0 else hs * factor(error)
            if error <= 1.0:
                row = 1 - row
                bends = follows and bent(b, w, t + done + hs, row)
                if bends and hs > _BENT * math.sqrt(tolerance) * longest_step(b, w):
                    row, error, ahead = 1 - row, np.inf, NEARER * hs
            if error <= 1.0:
                done, doubtful = end if count == 1.0 else done + hs, hides
                go_on(w, hs, follows)
                if count > 1.0 or (ahead > b[following] and not judged):
                    b[following] = min(ahead, longest_step(b, w))
                continue
            back = start if judged else x0
            for i in range(n):
                b[i] = w[back + i]
            if judged:
                done, row, w[known], doubtful = begin, 0, 0.0, False
            b[following] = ahead
            if ahead < smallest:
                return TOO_SMALL
        return 0

    return explicit

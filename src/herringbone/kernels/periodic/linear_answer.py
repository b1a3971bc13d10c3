"""What the averaged linear equations of a body answer to slow forces, and to harmonics."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from herringbone.kernels.compiling.jit import inner
from herringbone.kernels.periodic.complex_solve import complex_solve
from herringbone.kernels.periodic.harmonics import HALF, SAMPLES, add_harmonic, harmonic
from herringbone.kernels.periodic.places import Body, Places
from herringbone.kernels.stepping.newton import solve

_TURN = 6.283185307179586


class LinearAnswer(NamedTuple):
    """Kernels.

    Attributes:
        follow: (b, r) gives displacements (m,) under slow forces; the free coordinate stays.
        vibrate: (b, w) makes the equations of a harmonic of w [rad/s].
        correct: (b, period, none) changes the motion by what its accelerations lack.
    """

    follow: Callable
    vibrate: Callable
    correct: Callable


def linear_answer(body: Body, at: Places, owner: str) -> LinearAnswer:
    """Compile them; `owner`: name of the component, for messages."""
    m, free = len(body.xs), body.free
    k_at, c_at, re_at, im_at, motion_at = at.k, at.c, at.re, at.im, at.motion
    g_at, mean_at, drift_at, x_at, y_at = at.g, at.mean, at.drift, at.x, at.y
    order_at, found_at, table_at, end = at.order, at.found, at.table, at.end

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

    return LinearAnswer(follow, vibrate, correct)

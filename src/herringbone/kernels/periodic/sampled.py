"""What the equations of a body give along a motion, and on average over a period."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from herringbone.kernels.compiling.jit import inner
from herringbone.kernels.periodic.harmonics import SAMPLES, WINDOW, split
from herringbone.kernels.periodic.places import Body, Places
from herringbone.kernels.steppers import Rhs

_PHASES, _DIFFERENCE = 8, 1e-3
"""Phases over which stiffness and damping are averaged; displacement over the usual size."""
_SLOWEST = 100.0
"""Least angular frequency [rad/s] with which a displacement makes that of its rate."""
_TURN = 6.283185307179586


class Sampling(NamedTuple):
    """Kernels.

    Attributes:
        turned: (b, t) puts the states in which the search begins at another time.
        accelerate: (b, t, r) gives accelerations (m,) of the states.
        average: (b, period) makes stiffness and damping.
        sample: (b, period) gives what accelerations of the motion lack, and the largest of it.
    """

    turned: Callable
    accelerate: Callable
    average: Callable
    sample: Callable


def sampling(rhs: Rhs, body: Body, at: Places, owner: str) -> Sampling:
    """Compile them; `owner`: name of the component, for messages."""
    turned, accelerate = _turner(body, at, owner), _accelerator(rhs, body, at, owner)
    average = _averager(turned, accelerate, body, at, owner)
    return Sampling(turned, accelerate, average, _sampler(turned, accelerate, body, at, owner))


def _turner(body: Body, at: Places, owner: str) -> Callable:
    turning, turns, n = body.turning, len(body.turning), body.states
    dx_at, kept_at = at.dx, at.kept

    @inner(owner)
    def turned(b: np.ndarray, t: float) -> None:
        """The states in which the search begins, at another time."""
        for i in range(n):
            b[i] = b[kept_at + i]
        for k in range(turns):
            b[turning[k]] += b[dx_at + turning[k]] * t

    return turned


def _accelerator(rhs: Rhs, body: Body, at: Places, owner: str) -> Callable:
    vs, turning = body.vs, body.turning
    m, turns = len(vs), len(turning)
    dx_at, kept_at = at.dx, at.kept

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

    return accelerate


def _averager(
    turned: Callable, accelerate: Callable, body: Body, at: Places, owner: str
) -> Callable:
    xs, vs, sizes, m = body.xs, body.vs, body.sizes, len(body.xs)
    k_at, mean_at, drift_at, x_at = at.k, at.mean, at.drift, at.x

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

    return average


def _sampler(
    turned: Callable, accelerate: Callable, body: Body, at: Places, owner: str
) -> Callable:
    xs, vs, m = body.xs, body.vs, len(body.xs)
    motion_at, g_at, mean_at, drift_at, x_at = at.motion, at.g, at.mean, at.drift, at.x

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

    return sample

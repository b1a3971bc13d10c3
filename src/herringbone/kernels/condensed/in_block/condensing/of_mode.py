"""What one modal coordinate does over a step, at its start and under channels' polynomials.

phi functions of the eigenvalues (M. Hochbruck and A. Ostermann, Exponential integrators, Acta
Numerica 19, 2010, section 2). Complex numbers are pairs of reals.
"""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import outside, rare
from herringbone.kernels.condensed.in_block.form import Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces
from herringbone.kernels.elementary import exponential, sine_and_cosine

_SERIES = 18
"""Terms of the series for arguments up to 1."""


@rare
def powers(a: float, b: float, t: float, count: int, re: np.ndarray, im: np.ndarray) -> None:
    """Integrals of exp(z (t - s)) (s / t)^j from 0 to t, j = 0 ... count - 1, z = a + i b.

    Behind them stands exp(z t).
    """
    x, y = a * t, b * t
    size = exponential(x)
    s, c = sine_and_cosine(y)
    re[count], im[count] = size * c, size * s
    if x * x + y * y < 1.0:
        p, q = t / count, 0.0
        re[count - 1], im[count - 1] = p, q
        for k in range(_SERIES):
            p, q = (p * x - q * y) / (k + count + 1), (p * y + q * x) / (k + count + 1)
            re[count - 1], im[count - 1] = re[count - 1] + p, im[count - 1] + q
        for j in range(count - 1, 0, -1):
            re[j - 1] = (t + x * re[j] - y * im[j]) / j
            im[j - 1] = (x * im[j] + y * re[j]) / j
        return
    per = 1.0 / (x * x + y * y)
    p, q = t * (re[count] - 1.0), t * im[count]
    for j in range(count):
        re[j], im[j] = (p * x + q * y) * per, (q * x - p * y) * per
        p, q = (j + 1) * re[j] - t, (j + 1) * im[j]


def weight_writer(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile weights(w, mode, c, h): integrals up to the place c of a step of length h [s].

    They are left in `at.room`, for `start_adder` and `channel_adder`.
    """
    fit, count = form.fit.ravel(), form.degree + 1
    room, rates, capacity = at.room, at.rates, at.capacity

    @outside(owner)
    def weights(w: np.ndarray, mode: int, c: float, h: float) -> None:
        """Write, for every node, integrals of what acts there, once and twice."""
        re, im, weight = w[room : room + 16], w[room + 16 : room + 32], w[room + 32 : room + 64]
        t = c * h
        powers(w[rates + mode], w[rates + capacity + mode], t, count + 1, re, im)
        for n in range(count):
            for part in range(4):
                weight[4 * n + part] = 0.0
            share = 1.0
            for j in range(count):
                by = share * fit[j * count + n]
                weight[4 * n] += by * re[j]
                weight[4 * n + 1] += by * im[j]
                weight[4 * n + 2] += by * re[j + 1] * t / (j + 1)
                weight[4 * n + 3] += by * im[j + 1] * t / (j + 1)
                share *= c

    return weights


def start_adder(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile of_start(w, begin, mode, i), for the rung that begins there."""
    degree, arguments, rows = form.degree, form.arguments, form.rows
    count, capacity, room, carg = degree + 1, at.capacity, at.room, at.carg

    @outside(owner)
    def of_start(w: np.ndarray, begin: int, mode: int, i: int) -> None:
        """Add what a mode at the start does at the node i, counted from 0 after the start."""
        re, im, modes = w[room : room + 16], w[room + 16 : room + 32], int(w[at.modes])
        e_re, e_im = re[count + 1], im[count + 1]
        first = at.full + (mode * degree + i) * arguments
        second = first + modes * degree * arguments
        for k in range(arguments):
            p, q = w[carg + k * capacity + mode], w[carg + (arguments + k) * capacity + mode]
            w[first + k] = p * e_re - q * e_im
            w[second + k] = -(p * e_im + q * e_re)
        for r in range(int(w[at.rotations])):
            turns = at.turns + 2 * r * capacity + mode
            x, y = w[turns], w[turns + capacity]
            grow_re, grow_im = x * re[0] - y * im[0], x * im[0] + y * re[0]
            for k in range(arguments):
                of_angle = w[at.of_angles + r * arguments + k]
                w[first + k] += of_angle * grow_re
                w[second + k] -= of_angle * grow_im
            if i == degree - 1:
                to = begin + at.of_state + mode * at.width + rows + r
                w[to], w[to + modes * at.width] = grow_re, -grow_im
        if i == degree - 1:
            w[begin + at.turn + mode], w[begin + at.turn + modes + mode] = e_re, e_im

    return of_start


def channel_adder(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile of_channel(w, begin, mode, i, channel), for the rung that begins there."""
    degree, arguments, channels = form.degree, form.arguments, form.channels
    count, capacity, room, carg, bq = degree + 1, at.capacity, at.room, at.carg, at.bq

    @outside(owner)
    def of_channel(w: np.ndarray, begin: int, mode: int, i: int, channel: int) -> None:
        """Add what a channel does by a mode at the node i."""
        weight, modes = w[room + 32 : room + 64], int(w[at.modes])
        g, h = w[bq + channel * capacity + mode], w[bq + (channels + channel) * capacity + mode]
        if g == 0.0 and h == 0.0:
            return
        for n in range(count):
            p = weight[4 * n] * g - weight[4 * n + 1] * h
            q = weight[4 * n] * h + weight[4 * n + 1] * g
            f = weight[4 * n + 2] * g - weight[4 * n + 3] * h
            s = weight[4 * n + 2] * h + weight[4 * n + 3] * g
            given = channel * count + n
            to = at.full_inputs + (given * degree + i) * arguments
            push = begin + at.push + given * at.q_size
            for k in range(arguments):
                own = carg + k * capacity + mode
                w[to + k] += p * w[own] - q * w[own + arguments * capacity]
            for r in range(int(w[at.rotations])):
                turns = at.turns + 2 * r * capacity + mode
                angle = f * w[turns] - s * w[turns + capacity]
                for k in range(arguments):
                    w[to + k] += angle * w[at.of_angles + r * arguments + k]
                if i == degree - 1:
                    w[push + 2 * modes + r] += angle
            if i == degree - 1:
                w[push + mode], w[push + modes + mode] = p, q

    return of_channel

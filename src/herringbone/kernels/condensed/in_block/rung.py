"""Matrices of one step of modal coordinates under channels that are polynomials over it.

They are those of `analysis.twin.condensed.rungs`, in the kernel language: phi functions of the
eigenvalues (M. Hochbruck and A. Ostermann, Exponential integrators, Acta Numerica 19, 2010,
section 2). Complex numbers are pairs of reals.
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


def rung_maker(  # noqa: PLR0915 (kernels that share their layout)
    form: Form, at: WorkPlaces, owner: str
) -> Callable[[np.ndarray, int, float], None]:
    """Compile make(w, rung, h): writes the matrices of steps of a length [s]."""
    nodes, fit = form.nodes, form.fit.ravel()
    degree, arguments, channels, values = form.degree, form.arguments, form.channels, form.values
    count, whole, capacity, room = degree + 1, degree * arguments, at.capacity, at.room
    carg, bq, angles = at.carg, at.bq, len(form.turning)
    directions, stiff = form.directions.ravel(), np.array(form.stiff)
    sharp, sharp_count, rows = form.sharp.ravel(), len(form.sharp), form.rows
    tangents, unknowns, of_given = (
        len(form.directions),
        len(form.stiff),
        at.full + at.q_size * whole,
    )

    @outside(owner)
    def weights(w: np.ndarray, mode: int, c: float, h: float) -> None:
        """Write, for every node, integrals of what acts there, once and twice."""
        re, im, weight = w[room : room + 16], w[room + 16 : room + 32], w[room + 32 : room + 64]
        t = c * h
        powers(w[at.rates + mode], w[at.rates + capacity + mode], t, count + 1, re, im)
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

    @outside(owner)
    def of_start(w: np.ndarray, begin: int, mode: int, i: int) -> None:
        """Add what a mode at the start does at the node i, counted from 0 after the start."""
        re, im, modes = w[room : room + 16], w[room + 16 : room + 32], int(w[at.modes])
        e_re, e_im = re[count + 1], im[count + 1]
        first = at.full + mode * whole + i * arguments
        second = first + modes * whole
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
            to, push = of_given + given * whole + i * arguments, begin + at.push + given * at.q_size
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

    @outside(owner)
    def direct(w: np.ndarray) -> None:
        """Add what signals, inputs and the 1 do to arguments at once, and angles."""
        for channel in range(values, channels):
            for i in range(degree):
                to = of_given + (channel * count + i + 1) * whole + i * arguments
                for k in range(arguments):
                    w[to + k] += w[at.of_channels + k * channels + channel]
        for r in range(int(w[at.rotations])):
            to = at.full + (2 * int(w[at.modes]) + r) * whole
            for i in range(degree):
                for k in range(arguments):
                    w[to + i * arguments + k] = w[at.of_angles + r * arguments + k]

    @outside(owner)
    def slopes(w: np.ndarray, begin: int) -> None:
        """Write directions of the tangents over the unknowns."""
        for s in range(unknowns):
            for n in range(degree):
                given = of_given + (int(stiff[s]) * count + n + 1) * whole
                to = begin + at.along + (s * degree + n) * degree * tangents
                for i in range(degree):
                    for tangent in range(tangents):
                        total = 0.0
                        for k in range(arguments):
                            total += (
                                directions[tangent * arguments + k] * w[given + i * arguments + k]
                            )
                        w[to + i * tangents + tangent] = total

    @outside(owner)
    def as_inputs(w: np.ndarray, first: int, size: int) -> None:
        """From values at the nodes to inputs, see `channels.inputs`."""
        for channel in range(channels):
            to = first + channel * count * size
            end = to + degree * size
            for k in range(size):
                for n in range(1, count):
                    w[to + k] += w[to + n * size + k]
                for n in range(1, degree):
                    w[end + k] += nodes[n] * w[to + n * size + k]

    @outside(owner)
    def wanted(w: np.ndarray, first: int, to: int, count: int) -> None:
        """Write, of rows over all nodes, what is wanted in a step."""
        for row in range(count):
            own, target = first + row * whole, to + row * at.width
            for i in range(degree - 1):
                for s in range(sharp_count):
                    total = 0.0
                    for k in range(arguments):
                        total += sharp[s * arguments + k] * w[own + i * arguments + k]
                    w[target + i * sharp_count + s] = total
            for k in range(arguments):
                w[target + (degree - 1) * sharp_count + k] = w[own + whole - arguments + k]

    @outside(owner)
    def make(w: np.ndarray, rung: int, h: float) -> None:
        begin = at.rungs + rung * at.rung_size
        for k in range(at.rung_size):
            w[begin + k] = 0.0
        for k in range((at.q_size + channels * count) * whole):
            w[at.full + k] = 0.0
        for i in range(degree):
            for mode in range(int(w[at.modes])):
                weights(w, mode, nodes[i + 1], h)
                of_start(w, begin, mode, i)
                for channel in range(channels):
                    of_channel(w, begin, mode, i, channel)
        direct(w)
        slopes(w, begin)
        as_inputs(w, of_given, whole)
        as_inputs(w, begin + at.push, at.q_size)
        wanted(w, at.full, begin + at.of_state, 2 * int(w[at.modes]) + angles)
        wanted(w, of_given, begin + at.of_inputs, channels * count)

    return make

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
    degree, arguments, channels = form.degree, form.arguments, form.channels
    width, count, rung_size, capacity = at.rows, degree + 1, at.rung_size, at.capacity
    carg, bq, turns, rates = at.carg, at.bq, at.turns, at.rates
    of_angle, room = at.of_angle, at.room
    directions, stiff = form.directions.ravel(), np.array(form.stiff)
    tangents, unknowns = len(form.directions), len(form.stiff)

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

    @outside(owner)
    def of_mode(w: np.ndarray, begin: int, mode: int, i: int) -> None:
        """Add what a mode does at the node i, counted from 0 after the start."""
        re, im, weight = w[room : room + 16], w[room + 16 : room + 32], w[room + 32 : room + 64]
        x, y = w[turns + mode], w[turns + capacity + mode]
        modes = int(w[at.modes])
        e_re, e_im = re[count + 1], im[count + 1]
        grow_re, grow_im = x * re[0] - y * im[0], x * im[0] + y * re[0]
        first = begin + at.q_rows + mode * width + i * arguments
        second = first + modes * width
        for k in range(arguments):
            p, q = w[carg + k * capacity + mode], w[carg + (arguments + k) * capacity + mode]
            w[first + k] = p * e_re - q * e_im + w[of_angle + k] * grow_re
            w[second + k] = -(p * e_im + q * e_re) - w[of_angle + k] * grow_im
        last = i == degree - 1
        if last:
            w[begin + at.turn + mode], w[begin + at.turn + capacity + mode] = e_re, e_im
            w[begin + at.angle + mode] = grow_re
            w[begin + at.angle + modes + mode] = -grow_im
        for channel in range(channels):
            g, h = w[bq + channel * capacity + mode], w[bq + (channels + channel) * capacity + mode]
            if g == 0.0 and h == 0.0:
                continue
            for n in range(count):
                p = weight[4 * n] * g - weight[4 * n + 1] * h
                q = weight[4 * n] * h + weight[4 * n + 1] * g
                r = weight[4 * n + 2] * g - weight[4 * n + 3] * h
                s = weight[4 * n + 2] * h + weight[4 * n + 3] * g
                angle = r * x - s * y
                given = channel * count + n
                to = begin + at.of_inputs + given * width + i * arguments
                for k in range(arguments):
                    w[to + k] += (
                        p * w[carg + k * capacity + mode]
                        - q * w[carg + (arguments + k) * capacity + mode]
                        + angle * w[of_angle + k]
                    )
                if last:
                    push = begin + at.push + given * at.q_size
                    w[push + mode], w[push + modes + mode] = p, q
                    w[push + 2 * modes] += angle

    @outside(owner)
    def differences(w: np.ndarray, first: int, size: int) -> None:
        """Let the first node of each channel stand for the same value at all nodes."""
        for channel in range(channels):
            to = first + channel * count * size
            for n in range(1, count):
                for k in range(size):
                    w[to + k] += w[to + n * size + k]

    @outside(owner)
    def slopes(w: np.ndarray, begin: int) -> None:
        """Write directions of the tangents over the unknowns."""
        for i in range(degree):
            for tangent in range(tangents):
                for s in range(unknowns):
                    for n in range(degree):
                        given = int(stiff[s]) * count + n + 1
                        row = begin + at.of_inputs + given * width + i * arguments
                        total = 0.0
                        for k in range(arguments):
                            total += directions[tangent * arguments + k] * w[row + k]
                        to = (i * tangents + tangent) * unknowns * degree + s * degree + n
                        w[begin + at.along + to] = total

    @outside(owner)
    def make(w: np.ndarray, rung: int, h: float) -> None:
        begin = at.rungs + rung * rung_size
        for k in range(rung_size):
            w[begin + k] = 0.0
        for i in range(degree):
            for mode in range(int(w[at.modes])):
                weights(w, mode, nodes[i + 1], h)
                of_mode(w, begin, mode, i)
        differences(w, begin + at.of_inputs, width)
        differences(w, begin + at.push, at.q_size)
        slopes(w, begin)

    return make

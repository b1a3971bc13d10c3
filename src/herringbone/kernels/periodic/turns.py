"""What returns with the turns of two gears: harmonics of samples, fitted by least squares."""

import math

import numpy as np

from herringbone.kernels.compiling.jit import kernel
from herringbone.kernels.elementary import sine_and_cosine
from herringbone.kernels.stepping.newton import solve

INSTANTS = 32
"""At which samples are taken, over a turn of the larger gear."""
_UNKNOWNS = 5
"""Mean, cosines and sines."""
_TURN = 6.283185307179586
_SAME = 1e-9


def turns_scratch(coordinates: int) -> int:
    """Length of the scratch space of `fit_turns`."""
    return 4 * coordinates + 2 * _UNKNOWNS * _UNKNOWNS + 4 * _UNKNOWNS


@kernel
def instant(k: int, turns: tuple[float, float]) -> float:
    """Of the k-th sample: whole mesh periods; `turns`: mesh periods per turn of both gears."""
    return float(math.floor(k * max(turns[0], turns[1]) / INSTANTS + 0.5))


@kernel
def _unknowns(turns: tuple[float, float]) -> int:
    """Gears that turn alike have one harmonic."""
    return 3 if abs(turns[0] - turns[1]) <= _SAME * turns[0] else _UNKNOWNS


@kernel
def _shapes(k: int, turns: tuple[float, float], f: np.ndarray) -> None:
    """1, and cosine and sine of both angles, at the k-th instant."""
    at = instant(k, turns)
    f[0] = 1.0
    s, c = sine_and_cosine(_TURN * at / turns[0])
    f[1], f[2] = c, s
    s, c = sine_and_cosine(_TURN * at / turns[1])
    f[3], f[4] = c, s


@kernel
def fit_turns(g: np.ndarray, turns: tuple[float, float], m: int, scratch: np.ndarray) -> int:
    """Fit the harmonics of order 1 of both gears; returns of how many gears there are some.

    Args:
        g: samples (INSTANTS, m).
        turns: mesh periods per turn of both gears.
        m: number of columns.
        scratch: `turns_scratch` long; its first 4 m become, gear by gear, x and y (m,) each: the
            harmonic is Re((x + i y) exp(i angle)).
    """
    n, size = _unknowns(turns), _UNKNOWNS * _UNKNOWNS
    end = 4 * m + size
    normal, a = scratch[4 * m : end], scratch[end : end + size]
    end += size
    f, r = scratch[end : end + 5], scratch[end + 5 : end + 10]
    order, x = scratch[end + 10 : end + 15], scratch[end + 15 : end + 20]
    for i in range(size):
        normal[i] = 0.0
    for k in range(INSTANTS):
        _shapes(k, turns, f)
        for i in range(n):
            for j in range(n):
                normal[i * n + j] += f[i] * f[j]
    for column in range(m):
        for i in range(n):
            r[i] = 0.0
        for k in range(INSTANTS):
            _shapes(k, turns, f)
            for i in range(n):
                r[i] += f[i] * g[k * m + column]
        for i in range(n * n):
            a[i] = normal[i]
        solve(a, r, order, x, n)
        for gear in range(n // 2):
            scratch[2 * gear * m + column] = x[1 + 2 * gear]
            scratch[(2 * gear + 1) * m + column] = -x[2 + 2 * gear]
    return n // 2

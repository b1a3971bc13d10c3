"""Piecewise cubic interpolation on plain arrays: slopes and Hermite evaluation."""

import math

import numpy as np

from herringbone.kernels.compiling.jit import kernel

_ROOT = math.sqrt(3.0) - 2.0


@kernel
def periodic_slopes(
    y: np.ndarray, at: int, stride: int, count: int, slopes: np.ndarray, to: int
) -> None:
    """Slopes per interval of the C2 periodic cubic spline through equidistant values.

    m[i-1] + 4 m[i] + m[i+1] = 3 (y[i+1] - y[i-1]) is solved by its two first-order factors
    (M. Unser, IEEE Signal Processing Magazine 16, 1999, box 2), with periodic starts.

    Args:
        y: values at `y[at + i * stride]`, i < count.
        slopes: written at `slopes[to + i * stride]`.
    """
    first = 0.0
    power = 1.0
    for k in range(count):
        i = (count - k) % count
        ahead, behind = (i + 1) % count, (i + count - 1) % count
        first -= power * _ROOT * 3.0 * (y[at + ahead * stride] - y[at + behind * stride])
        power *= _ROOT
    wrap = 1.0 - power
    value = first / wrap
    slopes[to] = value
    for i in range(1, count):
        ahead = (i + 1) % count
        value = _ROOT * (value - 3.0 * (y[at + ahead * stride] - y[at + (i - 1) * stride]))
        slopes[to + i * stride] = value
    last = 0.0
    power = 1.0
    for k in range(count):
        last += power * slopes[to + ((count - 1 + k) % count) * stride]
        power *= _ROOT
    value = last / wrap
    slopes[to + (count - 1) * stride] = value
    for i in range(count - 2, -1, -1):
        value = slopes[to + i * stride] + _ROOT * value
        slopes[to + i * stride] = value


@kernel
def monotone_slopes(x: np.ndarray, y: np.ndarray, count: int, slopes: np.ndarray) -> None:
    """Slopes of a C1 interpolant without overshoot; level at the first point.

    Harmonic means of F. N. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300-304;
    at the last point the secant, limited to three times itself by construction.
    """
    slopes[0] = 0.0
    for i in range(1, count - 1):
        left, right = x[i] - x[i - 1], x[i + 1] - x[i]
        before, after = (y[i] - y[i - 1]) / left, (y[i + 1] - y[i]) / right
        if before * after <= 0.0:
            slopes[i] = 0.0
        else:
            a, b = 2.0 * right + left, right + 2.0 * left
            slopes[i] = (a + b) / (a / before + b / after)
    slopes[count - 1] = (y[count - 1] - y[count - 2]) / (x[count - 1] - x[count - 2])


@kernel
def hermite(f: float, y0: float, y1: float, m0: float, m1: float) -> tuple[float, float]:
    """Value and slope at f in [0, 1] of the cubic with end values y and end slopes m."""
    c2 = 3.0 * (y1 - y0) - 2.0 * m0 - m1
    c3 = 2.0 * (y0 - y1) + m0 + m1
    return y0 + f * (m0 + f * (c2 + f * c3)), m0 + f * (2.0 * c2 + 3.0 * f * c3)

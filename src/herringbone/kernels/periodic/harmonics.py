"""Samples over a period, their harmonics, and motions made of harmonics."""

import numpy as np

from herringbone.kernels.compiling.jit import kernel
from herringbone.kernels.stepping.local_error import worse

SAMPLES = 128
"""In a period, even; half as many harmonics."""
HALF = SAMPLES // 2
WINDOW = 2 * SAMPLES + 1
"""Samples over two periods, both ends among them."""


@kernel
def split(g: np.ndarray, mean: np.ndarray, drift: np.ndarray, m: int) -> float:
    """Take apart what returns after a period and what does not; returns the largest of the former.

    Args:
        g: samples (2 SAMPLES + 1, m) around the middle one; the first SAMPLES become the returning
            part, from half a period before the middle on.
        mean, drift: (m,) of the rest: in the middle, and over a period.
        m: number of columns.
    """
    largest = 0.0
    for i in range(m):
        total = 0.5 * (g[i] + g[SAMPLES * m + i])
        for k in range(1, SAMPLES):
            total += g[k * m + i]
        for k in range(SAMPLES + 1):
            slow = total / SAMPLES
            if k == 0:
                drift[i] = -slow
            if k == HALF:
                mean[i] = slow
            if k == SAMPLES:
                drift[i] += slow
                break
            returning = g[(k + HALF) * m + i] - slow
            total += 0.5 * (g[(k + SAMPLES) * m + i] + g[(k + SAMPLES + 1) * m + i])
            total -= 0.5 * (g[k * m + i] + g[(k + 1) * m + i])
            g[k * m + i] = returning
        bend = 0.0
        for k in range(SAMPLES):
            bend += g[k * m + i] / SAMPLES
        mean[i] += bend  # a mean over a period lies beside a bent curve
        for k in range(SAMPLES):
            g[k * m + i] -= bend
            largest = worse(largest, abs(g[k * m + i]))
    return largest


@kernel
def harmonic(
    g: np.ndarray, h: int, table: np.ndarray, x: np.ndarray, y: np.ndarray, m: int
) -> float:
    """Harmonic h of what `split` leaves: sum of Re((x + i y) exp(i h phase)); its largest size."""
    largest = 0.0
    for i in range(m):
        x[i], y[i] = 0.0, 0.0
    for k in range(SAMPLES):
        at = (h * (k + HALF)) % SAMPLES
        c, s = table[at] / HALF, table[SAMPLES + at] / HALF
        for i in range(m):
            x[i] += c * g[k * m + i]
            y[i] -= s * g[k * m + i]
    for i in range(m):
        largest = worse(largest, abs(x[i]) + abs(y[i]))
    return largest


@kernel
def add_harmonic(
    x: np.ndarray, y: np.ndarray, h: int, w: float, table: np.ndarray, motion: np.ndarray, m: int
) -> None:
    """Add a harmonic to positions, velocities and accelerations (3, SAMPLES, m); w: its [rad/s]."""
    size = SAMPLES * m
    for k in range(SAMPLES):
        at = (h * k) % SAMPLES
        c, s = table[at], table[SAMPLES + at]
        for i in range(m):
            position = c * x[i] - s * y[i]
            motion[k * m + i] += position
            motion[size + k * m + i] -= w * (s * x[i] + c * y[i])
            motion[2 * size + k * m + i] -= w * w * position

"""Exact propagation of an oscillator under a polynomial force.

    q'' + 2 zeta w q' + w**2 q = sum_j c[j] (t/h)**j,  j = 0 ... 4

    [q, q'](h) = Phi [q, q'](0) + sum_j c[j] Gamma[j]

Phi and Gamma are blocks of one matrix exponential: the oscillator, driven by a chain of
integrators that makes (t/h)**j / j! (C. F. Van Loan, IEEE Trans. Autom. Control 23, 1978,
395-404), computed by scaling and squaring with a Taylor series. There is no division by w or by
1 - zeta**2, so that small w h, rigid-body modes (w = 0) and overdamped modes need no special case.
"""

import numpy as np

from herringbone.kernels.compiling.jit import hot, kernel

DEGREES = 5
PROPAGATOR = 4 + 2 * DEGREES
"""Entries of one oscillator's propagator: Phi by rows, then (Gamma_q, Gamma_v) by degree."""
_N = 2 + DEGREES
SCRATCH_SIZE = 3 * _N * _N
_TERMS = 16
SHORTEST_STEP = 1e-300
"""Step [s] below which 1 / h may overflow; what moves meanwhile is far below rounding."""
LONGEST_PHASE = 1e9
"""Phase [rad] of one step up to which rounding leaves the phase within 1e-6 rad."""


@kernel
def _multiply(s: np.ndarray, a: int, b: int, c: int) -> None:
    """c = a b for the block upper triangular matrices at these places of the scratch."""
    for i in range(_N):
        for j in range(_N):
            total = 0.0
            for k in range(_N):
                total += s[a + i * _N + k] * s[b + k * _N + j]
            s[c + i * _N + j] = total


@kernel
def propagator(w: float, zeta: float, h: float, out: np.ndarray, at: int, s: np.ndarray) -> None:
    """Write the propagator of one oscillator to `out[at:]`.

    Args:
        w: natural angular frequency [rad/s], >= 0.
        zeta: damping ratio, >= 0.
        h: step [s], >= 0 and at most LONGEST_PHASE / (w + 2 zeta w); below SHORTEST_STEP nothing
            moves.
        s: scratch (SCRATCH_SIZE long).
    """
    for i in range(PROPAGATOR):
        out[at + i] = 0.0
    if h < SHORTEST_STEP:
        out[at] = out[at + 3] = 1.0
        return
    # The velocity is scaled so that both states have the same size.
    scale = max(w, 1.0 / h)
    norm = max(h * scale, h * w * w / scale + 2.0 * zeta * w * h + 1.0)
    halvings, r = 0, 1.0
    while norm > 0.5:
        norm *= 0.5
        r *= 0.5
        halvings += 1
    m, e, x = 0, _N * _N, 2 * _N * _N
    for i in range(SCRATCH_SIZE):
        s[i] = 0.0
    s[m + 1] = r * h * scale
    s[m + _N] = -r * h * w * w / scale
    s[m + _N + 1] = -2.0 * r * zeta * w * h
    s[m + _N + 2] = r * h / scale
    for k in range(2, _N - 1):
        s[m + k * _N + k + 1] = r
    for i in range(_N):
        s[e + i * _N + i] = 1.0
    for k in range(_TERMS, 0, -1):
        _multiply(s, m, e, x)
        for i in range(_N * _N):
            s[e + i] = s[x + i] / k
        for i in range(_N):
            s[e + i * _N + i] += 1.0
    for _ in range(halvings):
        _multiply(s, e, e, x)
        for i in range(_N * _N):
            s[e + i] = s[x + i]
    out[at], out[at + 1] = s[e], s[e + 1] / scale
    out[at + 2], out[at + 3] = s[e + _N] * scale, s[e + _N + 1]
    factorial = 1.0
    for j in range(DEGREES):
        factorial *= max(j, 1)
        out[at + 4 + 2 * j] = s[e + 2 + j] * factorial
        out[at + 5 + 2 * j] = s[e + _N + 2 + j] * factorial * scale


@kernel
def powers_of(degree: int) -> int:
    """How many powers of the force `advance` takes for a degree; those beyond it are zero."""
    return 2 if degree < 2 else DEGREES


@hot
def advance(
    x: np.ndarray, phi: np.ndarray, f: np.ndarray, degree: int, room: int, count: int
) -> None:
    """Advance oscillators by a step; loops are over oscillators, which so go side by side.

    Args:
        x: coordinates, and `room` behind them velocities.
        phi: propagators of the step, by entry, then by oscillator (PROPAGATOR, room).
        f: forces over it, by power, then by oscillator (`powers_of` the degree, room).
        degree: of the forces.
        room: for oscillators.
        count: of oscillators.
    """
    m = room
    for i in range(count):
        q, v, f_0, f_1 = x[i], x[m + i], f[i], f[m + i]
        shift = phi[4 * m + i] * f_0 + phi[6 * m + i] * f_1
        push = phi[5 * m + i] * f_0 + phi[7 * m + i] * f_1
        x[i] = (phi[i] * q + phi[m + i] * v) + shift
        x[m + i] = (phi[2 * m + i] * q + phi[3 * m + i] * v) + push
    for i in range(count if degree > 1 else 0):
        f_2, f_3, f_4 = f[2 * m + i], f[3 * m + i], f[4 * m + i]
        x[i] += phi[8 * m + i] * f_2 + phi[10 * m + i] * f_3 + phi[12 * m + i] * f_4
        x[m + i] += phi[9 * m + i] * f_2 + phi[11 * m + i] * f_3 + phi[13 * m + i] * f_4


@hot
def next_interval(f: np.ndarray, degree: int, room: int, count: int) -> None:
    """Re-expand forces, as of `advance`, about the end of the step, for the next one as long."""
    for k in range(degree):
        for j in range(degree - 1, k - 1, -1):
            here, above = f[j * room : (j + 1) * room], f[(j + 1) * room : (j + 2) * room]
            for i in range(count):
                here[i] += above[i]

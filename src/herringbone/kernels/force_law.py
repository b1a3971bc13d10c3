"""Force law of one tooth mesh, F(phase, deflection), and its energy, from a stiffness table.

A table has secant stiffnesses K = F / x (x: deflection) at loads F_n and equidistant phases from 0,
for each side its own; rows of the CSV are side, F_n, phase, K. Phases p are counted in mesh
periods. The law interpolates K over p and u = 32 sqrt(x / limit); limit is the smallest x at which
the largest load is reached, over the phases of the side's table.

    F(p, x) = K(p, u) x,    dF/dx = K + u/2 dK/du,    0 <= x <= limit
    U(p, x) = 2 limit^2 / 32^4 * integral of K u^3 du from 0 to u,    dU/dx = F

*Nodes* are (i / 128, u = j), i = 0 ... 127, j = 0 ... 32. Their values are made in three steps:

1. At each phase of the table, K is a cubic Hermite spline over the u of the loads,
   u_n = 32 sqrt(F_n / (K_n limit)). Inside, its slopes are harmonic means (F. N. Fritsch and J.
   Butland, SIAM J. Sci. Stat. Comput. 5, 1984, 300-304): with widths h, secants s of the intervals
   before (a) and after (b), 3 (h_a + h_b) / ((2 h_b + h_a) / s_a + (h_b + 2 h_a) / s_b), or 0 where
   s_a s_b <= 0. The slope is 0 at the first load, the last secant at the last one. K is constant
   below the first load (a load of zero lies at u = 0: there K leaves its limit with u^2).
   K and dK/du are taken at u = 0 ... 32.
2. Both are interpolated over the phases of the table by the periodic C2 cubic spline. Slopes of K
   are at most 2.5 times K over an interval: it does not swing below zero where it is zero at some
   phases, as under no load of relieved teeth.
3. Spline and slope are taken at the 128 phases of the nodes; there the same limit holds, also for
   dK/du.

*Between nodes*, K and dK/du at u = j and j + 1 are cubic Hermite functions of p, and K is the cubic
Hermite function of u with these values and slopes. So F is C1, periodic in p, and F(p, 0) = 0. U is
the exact integral of that F: a polynomial in u in every cell, whose sum up to u = j is again a
Hermite function of p. *Above the limit* the tangent k at the limit is kept:

    F = F_l + k (x - limit),    U = U_l + F_l (x - limit) + k (x - limit)^2 / 2

Table part: [limit, smallest deflection inside the table], then for every node (phase by phase) K,
dK/dp, dK/du, d2K/dp du, S, dS/dp, with S the integral of K u^3 du from 0 to j; slopes per interval.
"""

import math

import numpy as np

from herringbone.kernels.compiling.jit import kernel
from herringbone.kernels.splines import hermite, monotone_slopes, periodic_slopes

PHASES = 128
DEFLECTIONS = 33
LOADS = 64
NODE = 6
"""Numbers of a node."""
_LAST = DEFLECTIONS - 1
_STEEPEST = 2.5
_THIRD, _SIXTH, _SEVENTH = 1.0 / 3.0, 1.0 / 6.0, 1.0 / 7.0
_ROW = DEFLECTIONS * NODE
TABLE_SIZE = 2 + PHASES * _ROW
"""Length of the table part of one mesh."""
SCRATCH_SIZE = 4 * LOADS + 4 * PHASES
"""Length of the scratch space of `build`."""


@kernel
def _resample(
    values: np.ndarray, slopes: np.ndarray, count: int, b: np.ndarray, to: int, slope_to: int
) -> None:
    """Evaluate a periodic spline with `count` knots at the PHASES nodes of the table."""
    ratio = count / PHASES
    for i in range(PHASES):
        p = i * ratio
        k = int(p)
        following = (k + 1) % count
        value, slope = hermite(p - k, values[k], values[following], slopes[k], slopes[following])
        b[to + i * _ROW] = value
        b[slope_to + i * _ROW] = slope * ratio


@kernel
def _limited(slope: float, value: float) -> float:
    """A slope over an interval with which a cubic between values of zero or more is not negative.

    J. W. Schmidt and W. Hess, BIT 28, 1988, 340-352: -3 times the value at least at its beginning,
    3 times at most at its end. Here both at both, and less, for what lies between nodes.
    """
    most = _STEEPEST * max(0.0, value)
    return max(-most, min(most, slope))


@kernel
def build(
    loads: np.ndarray, stiffness: np.ndarray, phases: int, b: np.ndarray, at: int, s: np.ndarray
) -> None:
    """Make the table part at `b[at:]`.

    Args:
        loads: normal forces [N], ascending from zero or above, at most LOADS.
        stiffness: secant stiffness [N/m], `stiffness[load * phases + phase]`.
        phases: equidistant phases in a mesh period, at most PHASES.
        b, at: block and start of the table part (TABLE_SIZE long).
        s: scratch (SCRATCH_SIZE long).
    """
    count = loads.size
    limit, smallest = math.inf, 0.0
    for i in range(phases):
        limit = min(limit, loads[count - 1] / stiffness[(count - 1) * phases + i])
        if loads[0] > 0.0:
            smallest = max(smallest, loads[0] / stiffness[i])
    b[at], b[at + 1] = limit, smallest
    u, k, m = s[:LOADS], s[LOADS : 2 * LOADS], s[2 * LOADS : 3 * LOADS]
    column, slope = s[4 * LOADS : 4 * LOADS + PHASES], s[4 * LOADS + PHASES :]
    base = at + 2
    for j in range(DEFLECTIONS):
        for what in range(2):
            for i in range(phases):
                for n in range(count):
                    k[n] = stiffness[n * phases + i]
                    u[n] = 0.0
                    if loads[n] > 0.0:
                        u[n] = math.sqrt(loads[n] / (k[n] * limit)) * _LAST
                monotone_slopes(u, k, count, m)
                if loads[0] == 0.0:
                    m[0] = 0.0  # the secant leaves its limit with the deflection, not with its root
                column[i] = _at(u, k, m, count, j, what)
            periodic_slopes(column, 0, 1, phases, slope, 0)
            if what == 0:
                for i in range(phases):
                    slope[i] = _limited(slope[i], column[i])
            _resample(
                column,
                slope,
                phases,
                b,
                base + j * NODE + 2 * what,
                base + j * NODE + 2 * what + 1,
            )
    for i in range(PHASES):
        for j in range(DEFLECTIONS):
            n = base + i * _ROW + j * NODE
            b[n] = max(0.0, b[n])
            b[n + 1], b[n + 2] = _limited(b[n + 1], b[n]), _limited(b[n + 2], b[n])
    _cumulate(b, base)


@kernel
def _cumulate(b: np.ndarray, base: int) -> None:
    """Write the integrals of K u^3 and dK/dp u^3 from 0 to every node."""
    for i in range(PHASES):
        total, slope = 0.0, 0.0
        for j in range(DEFLECTIONS):
            n = base + i * _ROW + j * NODE
            b[n + 4], b[n + 5] = total, slope
            if j < _LAST:
                m = n + NODE
                total += _cubed(j, 1.0, b[n], b[m], b[n + 2], b[m + 2])
                slope += _cubed(j, 1.0, b[n + 1], b[m + 1], b[n + 3], b[m + 3])


@kernel
def _at(u: np.ndarray, k: np.ndarray, m: np.ndarray, count: int, x: float, what: int) -> float:
    """Interpolated stiffness (what = 0) or its slope (1) at x; level below the first load."""
    if x <= u[0]:
        return k[0] if what == 0 else 0.0
    n = 1
    while n < count - 1 and x > u[n]:
        n += 1
    width = u[n] - u[n - 1]
    value, slope = hermite((x - u[n - 1]) / width, k[n - 1], k[n], m[n - 1] * width, m[n] * width)
    return value if what == 0 else slope / width


@kernel
def _cubed(j: int, f: float, y0: float, y1: float, m0: float, m1: float) -> float:
    """Integral from j to j + f of u^3 times the cubic with end values y and end slopes m."""
    c2 = 3.0 * (y1 - y0) - 2.0 * m0 - m1
    c3 = 2.0 * (y0 - y1) + m0 + m1
    square, cube = 1.0 * j * j, 1.0 * j * j * j
    g0 = cube + f * (1.5 * square + f * (j + 0.25 * f))
    g1 = 0.5 * cube + f * (square + f * (0.75 * j + 0.2 * f))
    g2 = _THIRD * cube + f * (0.75 * square + f * (0.6 * j + _SIXTH * f))
    g3 = 0.25 * cube + f * (0.6 * square + f * (0.5 * j + _SEVENTH * f))
    return f * (y0 * g0 + f * (m0 * g1 + f * (c2 * g2 + f * c3 * g3)))


@kernel
def _cell(at: int, phase: float, u: float) -> tuple[int, int, int, float]:
    """Indices of a cell's nodes at its phases, its number over u, and the place over its phases."""
    p = phase - math.floor(phase)
    # The floor is undefined beyond 2**63: a diverging run must not read outside the table.
    p = p * PHASES if 0.0 <= p < 1.0 else 0.0
    i = int(p)
    j = min(int(u), DEFLECTIONS - 2)
    here = at + 2 + i * _ROW + j * NODE
    there = at + 2 + ((i + 1) % PHASES) * _ROW + j * NODE
    return here, there, j, p - i


@kernel
def law(b: np.ndarray, at: int, phase: float, deflection: float) -> tuple[float, float, float]:
    """Elastic force [N], tangent stiffness [N/m] and dU/d(phase) [J] of one mesh.

    Args:
        b, at: block and start of the table part.
        phase: mesh periods.
        deflection: zero or more [m].
    """
    limit = b[at]
    inner = min(deflection, limit)
    beyond = deflection - inner
    u = math.sqrt(inner / limit) * _LAST
    here, there, j, p = _cell(at, phase, u)
    k0, a0 = hermite(p, b[here], b[there], b[here + 1], b[there + 1])
    m0, n0 = hermite(p, b[here + 2], b[there + 2], b[here + 3], b[there + 3])
    _, below = hermite(p, b[here + 4], b[there + 4], b[here + 5], b[there + 5])
    here += NODE
    there += NODE
    k1, a1 = hermite(p, b[here], b[there], b[here + 1], b[there + 1])
    m1, n1 = hermite(p, b[here + 2], b[there + 2], b[here + 3], b[there + 3])
    f = u - j
    secant, slope = hermite(f, k0, k1, m0, m1)
    tangent = secant + 0.5 * u * slope
    change = 2.0 * limit * limit / _LAST**4 * (below + _cubed(j, f, a0, a1, n0, n1))
    if beyond > 0.0:
        rise, bend = hermite(f, a0, a1, n0, n1)
        change += beyond * (rise * limit + 0.5 * beyond * (rise + 0.5 * u * bend))
    return secant * inner + tangent * beyond, tangent, PHASES * change


@kernel
def largest_force(b: np.ndarray, at: int) -> float:
    """The largest load [N] of a mesh's table."""
    largest, last = 0.0, at + 2 + _LAST * NODE
    for i in range(PHASES):
        largest = max(largest, b[last + i * _ROW])
    return largest * b[at]


@kernel
def energy(b: np.ndarray, at: int, phase: float, deflection: float) -> float:
    """Elastic energy U [J] of one mesh; arguments as of `law`."""
    limit = b[at]
    inner = min(deflection, limit)
    beyond = deflection - inner
    u = math.sqrt(inner / limit) * _LAST
    here, there, j, p = _cell(at, phase, u)
    k0, _ = hermite(p, b[here], b[there], b[here + 1], b[there + 1])
    m0, _ = hermite(p, b[here + 2], b[there + 2], b[here + 3], b[there + 3])
    below, _ = hermite(p, b[here + 4], b[there + 4], b[here + 5], b[there + 5])
    here += NODE
    there += NODE
    k1, _ = hermite(p, b[here], b[there], b[here + 1], b[there + 1])
    m1, _ = hermite(p, b[here + 2], b[there + 2], b[here + 3], b[there + 3])
    stored = 2.0 * limit * limit / _LAST**4 * (below + _cubed(j, u - j, k0, k1, m0, m1))
    force, tangent, _ = law(b, at, phase, inner)
    return stored + beyond * (force + 0.5 * beyond * tangent)


@kernel
def inside(b: np.ndarray, at: int, deflection: float) -> bool:
    """True if a deflection lies inside the table, or the teeth are apart."""
    return deflection <= 0.0 or b[at + 1] <= deflection <= b[at]

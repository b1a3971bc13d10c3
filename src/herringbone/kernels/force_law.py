"""Force law of one tooth mesh, F(phase, deflection), from a stiffness table over (phase, load).

The secant stiffness K is interpolated over phase p (mesh periods) and u = sqrt(deflection / limit):

    F = K(p, u) deflection,    dF/d(deflection) = K + u/2 dK/du

C1, periodic in p, F(p, 0) = 0. Below the smallest load of the table the secant is constant; from a
table that begins at zero load it leaves its limit with the deflection (dK/du = 0 at u = 0). Above
the limit (the smallest deflection at which the largest load is reached) the tangent is constant.
Table part: [limit, smallest deflection inside the table], then for every (phase, u) node the four
values K, dK/dp, dK/du, d2K/dp du per interval.
"""

import math

import numpy as np

from herringbone.kernels.jit import kernel
from herringbone.kernels.splines import hermite, monotone_slopes, periodic_slopes

PHASES = 128
DEFLECTIONS = 33
LOADS = 64
_NODE = 4
_ROW = DEFLECTIONS * _NODE
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
                        u[n] = math.sqrt(loads[n] / (k[n] * limit)) * (DEFLECTIONS - 1)
                monotone_slopes(u, k, count, m)
                if loads[0] == 0.0:
                    m[0] = 0.0  # the secant leaves its limit with the deflection, not with its root
                column[i] = _at(u, k, m, count, j, what)
            periodic_slopes(column, 0, 1, phases, slope, 0)
            _resample(
                column,
                slope,
                phases,
                b,
                base + j * _NODE + 2 * what,
                base + j * _NODE + 2 * what + 1,
            )


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
def _secant(b: np.ndarray, at: int, phase: float, u: float) -> tuple[float, float]:
    """K and dK/du at u in node intervals, 0 <= u <= DEFLECTIONS - 1."""
    p = phase - math.floor(phase)
    # The floor is undefined beyond 2**63: a diverging run must not read outside the table.
    p = p * PHASES if 0.0 <= p < 1.0 else 0.0
    i = int(p)
    p -= i
    j = min(int(u), DEFLECTIONS - 2)
    here = at + 2 + i * _ROW + j * _NODE
    there = at + 2 + ((i + 1) % PHASES) * _ROW + j * _NODE
    k0, _ = hermite(p, b[here], b[there], b[here + 1], b[there + 1])
    m0, _ = hermite(p, b[here + 2], b[there + 2], b[here + 3], b[there + 3])
    here += _NODE
    there += _NODE
    k1, _ = hermite(p, b[here], b[there], b[here + 1], b[there + 1])
    m1, _ = hermite(p, b[here + 2], b[there + 2], b[here + 3], b[there + 3])
    return hermite(u - j, k0, k1, m0, m1)


@kernel
def force_and_tangent(
    b: np.ndarray, at: int, phase: float, deflection: float
) -> tuple[float, float]:
    """Elastic force [N] and tangent stiffness [N/m] of one mesh; deflection >= 0 [m]."""
    limit = b[at]
    if deflection <= limit:
        u = math.sqrt(deflection / limit) * (DEFLECTIONS - 1)
        secant, slope = _secant(b, at, phase, u)
        return secant * deflection, secant + 0.5 * u * slope
    secant, slope = _secant(b, at, phase, DEFLECTIONS - 1.0)
    tangent = secant + 0.5 * (DEFLECTIONS - 1) * slope
    return secant * limit + tangent * (deflection - limit), tangent


@kernel
def inside(b: np.ndarray, at: int, deflection: float) -> bool:
    """True if a deflection lies inside the table, or the teeth are apart."""
    return deflection <= 0.0 or b[at + 1] <= deflection <= b[at]

r"""Force law of one pair of teeth whose flanks lean against each other, and its energy.

**Contact line.** q is the position of a pair of teeth [mesh periods since it entered]. With the
transverse contact ratio eps_a and the overlap ratio eps_b its line of contact lies between the
face coordinates (over b)

    from max(0, 1 - q / eps_b) to min(1, 1 + (eps_a - q) / eps_b)        (eps_b = 0: 0 and 1)

m(q) is their mean and h(q) half of their difference; both ends are 1 before the pair enters, and 0
after it has left. How deep the flanks are in each other is linear along the line: x in its middle,
y = h times the slope over the face. With

    rho = sqrt(x^2 + y^2),   s = y / (x + rho),   u = sqrt(rho / (rho + D)),

the energy of the pair is rho^2 M(q, s, u); were all stiffnesses constant, M would not depend on u.
D is a depth of the size that matters. There is no contact where |y| >= 3 (x + rho).

**Between nodes.** Nodes are q = (first + i) / n, i = 0 ... count - 1; s = (j - 16) 3 / 16, j = 0
... 32; u = k / 8, k = 0 ... 8. m, h and M are cubic B-splines (M: their products) with
coefficients c by the values v of the nodes: c[i-1] + 4 c[i] + c[i+1] = 6 v[i]. Over q and s, c = v
at the two first and the two last nodes and outside of them, where these equations do not hold, and
M = 0; over u, c = v at the first and the last node, and c[-1] = 2 c[0] - c[1], at the end alike.

**Derivatives**, of one function that is twice differentiable; M_s = dM/ds and so on:

    dU/dx = A x - B y,   dU/dy = A y + B x,   dU/dq = rho^2 M_q
    A = 2 M + u (1 - u^2) M_u / 2,   B = (1 + s^2) M_s / 2

Table part: [first, n, count, D], then m and h by node, then M by node of q, s (from j = -1 to 33)
and u (from k = -1 to 9): the coefficients, over q from i = -1 to count.
"""

import math

import numpy as np

from herringbone.kernels.compiling.jit import kernel, rare

POSITIONS = 192
"""Most nodes over q."""
TILTS, DEPTHS = 33, 9
STEEPEST = 3.0
"""|s| at the first and last node."""
_PER_TILT, _PER_DEPTH = (TILTS - 1.0) / (2.0 * STEEPEST), DEPTHS - 1.0
_COLUMN = DEPTHS + 2
_ROW = (TILTS + 2) * _COLUMN
_SIXTH, _TWO_THIRDS = 1.0 / 6.0, 2.0 / 3.0
_LINES = 4
_VALUES = _LINES + 2 * (POSITIONS + 2)
TABLE_SIZE = _VALUES + (POSITIONS + 2) * _ROW
"""Length of the table part."""


@kernel
def ends(q: float, transverse: float, overlap: float) -> tuple[float, float]:
    """m and h of the line at q, by the contact ratios."""
    if overlap == 0.0:
        low, high = 0.0, 1.0
        if q <= 0.0 or q >= transverse:
            low = high = 0.5
    else:
        low = min(1.0, max(0.0, 1.0 - q / overlap))
        high = min(1.0, max(0.0, 1.0 + (transverse - q) / overlap))
    return 0.5 * (low + high), 0.5 * (high - low)


@rare
def _interpolate(
    b: np.ndarray, at: int, step: int, first: int, last: int, pivots: np.ndarray
) -> None:
    """Turn the values b[at + i step], first < i < last, into coefficients; those at both ends are.

    Args:
        pivots: scratch, `last` long.
    """
    pivots[first] = 0.0
    for i in range(first + 1, last):
        right = 6.0 * b[at + i * step] - b[at + (i - 1) * step]
        if i == last - 1:
            right -= b[at + last * step]
        pivots[i] = 1.0 / (4.0 - pivots[i - 1])
        b[at + i * step] = right * pivots[i]
    for i in range(last - 2, first, -1):
        b[at + i * step] -= pivots[i] * b[at + (i + 1) * step]


@kernel
def build(
    first: int,
    per_period: int,
    count: int,
    unit: float,
    transverse: float,
    overlap: float,
    b: np.ndarray,
    at: int,
    scratch: np.ndarray,
) -> None:
    """Make coefficients of the table part at `b[at:]`, where the values M stand at their nodes.

    Args:
        first, per_period, count: nodes over q.
        unit: D [m].
        transverse, overlap: contact ratios.
        b, at: block and start of the table part (TABLE_SIZE long).
        scratch: POSITIONS long.
    """
    b[at], b[at + 1], b[at + 2], b[at + 3] = first, per_period, count, unit
    for i in range(-1, count + 1):
        line = at + _LINES + 2 * (i + 1)
        b[line], b[line + 1] = ends((first + i) / per_period, transverse, overlap)
    for what in range(2):
        _interpolate(b, at + _LINES + 2 + what, 2, 1, count - 2, scratch)
    for j in range(2, TILTS - 2):
        for k in range(DEPTHS):
            _interpolate(b, node(at, 0, j, k), _ROW, 1, count - 2, scratch)
    for i in range(2, count - 2):
        for k in range(DEPTHS):
            _interpolate(b, node(at, i, 0, k), _COLUMN, 1, TILTS - 2, scratch)
        for j in range(2, TILTS - 2):
            column = node(at, i, j, 0)
            _interpolate(b, column, 1, 0, DEPTHS - 1, scratch)
            b[column - 1] = 2.0 * b[column] - b[column + 1]
            end = column + DEPTHS
            b[end] = 2.0 * b[end - 1] - b[end - 2]


@kernel
def node(at: int, i: int, j: int, k: int) -> int:
    """Where M of a node stands in the block."""
    return at + _VALUES + (i + 1) * _ROW + (j + 1) * _COLUMN + k + 1


@kernel
def _value(f: float, c0: float, c1: float, c2: float, c3: float) -> float:
    """Value of the spline at a place f in [0, 1] between nodes, with the coefficients around."""
    g = 1.0 - f
    ends = _SIXTH * (g * g * g * c0 + f * f * f * c3)
    near = _TWO_THIRDS - f * f * (1.0 - 0.5 * f)
    return ends + near * c1 + (_TWO_THIRDS - g * g * (1.0 - 0.5 * g)) * c2


@kernel
def _slope(f: float, c0: float, c1: float, c2: float, c3: float) -> float:
    """Derivative of the value over f."""
    g = 1.0 - f
    return 0.5 * (f * f * c3 - g * g * c0) + f * (1.5 * f - 2.0) * c1 + g * (2.0 - 1.5 * g) * c2


@kernel
def _bend(f: float, c0: float, c1: float, c2: float, c3: float) -> float:
    """Second derivative of the value over f."""
    return (1.0 - f) * c0 + (3.0 * f - 2.0) * c1 + (1.0 - 3.0 * f) * c2 + f * c3


@kernel
def _over_depths(b: np.ndarray, at: int, f: float) -> tuple[float, float, float]:
    """M, M_u and M_uu (per interval) of the four coefficients at `b[at:]`."""
    v0, v1, v2, v3 = b[at], b[at + 1], b[at + 2], b[at + 3]
    return (
        _value(f, v0, v1, v2, v3),
        _slope(f, v0, v1, v2, v3),
        _bend(f, v0, v1, v2, v3),
    )


@rare
def _over_tilts(
    b: np.ndarray, at: int, f: float, u: float
) -> tuple[float, float, float, float, float, float]:
    """M, M_s, M_ss, M_u, M_su and M_uu (per interval) of the 4 x 4 coefficients from `b[at]`."""
    v0, d0, e0 = _over_depths(b, at, u)
    v1, d1, e1 = _over_depths(b, at + _COLUMN, u)
    v2, d2, e2 = _over_depths(b, at + 2 * _COLUMN, u)
    v3, d3, e3 = _over_depths(b, at + 3 * _COLUMN, u)
    return (
        _value(f, v0, v1, v2, v3),
        _slope(f, v0, v1, v2, v3),
        _bend(f, v0, v1, v2, v3),
        _value(f, d0, d1, d2, d3),
        _slope(f, d0, d1, d2, d3),
        _value(f, e0, e1, e2, e3),
    )


@kernel
def line(b: np.ndarray, at: int, q: float) -> tuple[int, float, float, float, float, float]:
    """Where a pair of teeth is: number and place of the interval, m, h, dm/dq and dh/dq.

    The number is -1 if the pair is not in the table, then it does not touch.
    """
    place = q * b[at + 1] - b[at]
    if not 0.0 <= place < b[at + 2] - 1.0:
        return -1, 0.0, 0.0, 0.0, 0.0, 0.0
    i = int(place)
    f, c = place - i, at + _LINES + 2 * i
    return (
        i,
        f,
        _value(f, b[c], b[c + 2], b[c + 4], b[c + 6]),
        _value(f, b[c + 1], b[c + 3], b[c + 5], b[c + 7]),
        b[at + 1] * _slope(f, b[c], b[c + 2], b[c + 4], b[c + 6]),
        b[at + 1] * _slope(f, b[c + 1], b[c + 3], b[c + 5], b[c + 7]),
    )


@kernel
def touches(x: float, y: float) -> bool:
    """False if flanks with the depths x [m] in the middle and x +- y at the ends are apart."""
    return abs(y) < STEEPEST * (x + math.sqrt(x * x + y * y))


@kernel
def law(
    b: np.ndarray, at: int, i: int, f: float, x: float, y: float
) -> tuple[float, float, float, float, float]:
    """dU/dx [N], d2U/dx2 [N/m], dU/dy [N], dU/dq [J] and U [J] of a pair that touches.

    Args:
        b, at: block and start of the table part.
        i, f: number and place of its interval, see `line`.
        x, y: depth in the middle, and half of its difference over the line [m].
    """
    rho = math.sqrt(x * x + y * y)
    cos, sin = x / rho, y / rho
    s, u = y / (x + rho), math.sqrt(rho / (rho + b[at + 3]))
    j_place, k_place = (s + STEEPEST) * _PER_TILT, u * _PER_DEPTH
    j, k = int(j_place), min(int(k_place), DEPTHS - 2)
    j_place, k_place = j_place - j, k_place - k
    c = node(at, i - 1, j - 1, k - 1)
    m0, s0, ss0, u0, su0, uu0 = _over_tilts(b, c, j_place, k_place)
    m1, s1, ss1, u1, su1, uu1 = _over_tilts(b, c + _ROW, j_place, k_place)
    m2, s2, ss2, u2, su2, uu2 = _over_tilts(b, c + 2 * _ROW, j_place, k_place)
    m3, s3, ss3, u3, su3, uu3 = _over_tilts(b, c + 3 * _ROW, j_place, k_place)
    m = _value(f, m0, m1, m2, m3)
    m_q = b[at + 1] * _slope(f, m0, m1, m2, m3)
    turn = 0.5 * (1.0 + s * s) * _PER_TILT  # of s over the angle of (x, y), in intervals
    per_s = _value(f, s0, s1, s2, s3)
    per_angle = turn * per_s
    twice = turn * (turn * _value(f, ss0, ss1, ss2, ss3) + s * per_s)
    grow = 0.5 * u * (1.0 - u * u)  # of u over the logarithm of rho
    per_u = _PER_DEPTH * _value(f, u0, u1, u2, u3)
    both = turn * _PER_DEPTH * _value(f, su0, su1, su2, su3)
    bend = _PER_DEPTH * _PER_DEPTH * _value(f, uu0, uu1, uu2, uu3)
    a, across = 2.0 * m + grow * per_u, per_angle
    a_u = (2.5 - 1.5 * u * u) * per_u + grow * bend
    force = cos * a - sin * across
    tangent = cos * (force + grow * (cos * a_u - sin * both))
    tangent += sin * (sin * (a + twice) - cos * (across + grow * both))
    square = rho * rho
    return rho * force, tangent, rho * (sin * a + cos * across), square * m_q, square * m

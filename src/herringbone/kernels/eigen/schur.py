"""Real Schur form of a Hessenberg matrix by QR steps with two shifts.

B. T. Smith et al., Matrix Eigensystem Routines: EISPACK Guide, 1976: hqr2. Matrices (n, n) lie by
rows in flat arrays.
"""

import math

import numpy as np

from herringbone.kernels.compiling.jit import rare

_ROUNDED = 2.0**-52
_ITERATIONS = 60
_EXCEPTIONAL = 10


@rare
def _small(t: np.ndarray, n: int, end: int, norm: float) -> int:
    """First row of the last block that hangs together, and ends with row `end`."""
    first = end
    while first > 0:
        near = abs(t[(first - 1) * (n + 1)]) + abs(t[first * (n + 1)])
        if near == 0.0:
            near = norm
        if abs(t[first * n + first - 1]) < _ROUNDED * near:
            t[first * n + first - 1] = 0.0
            return first
        first -= 1
    return 0


@rare
def _split(t: np.ndarray, v: np.ndarray, n: int, k: int) -> None:
    """Make the block of rows k - 1 and k triangular if its eigenvalues are real."""
    w = t[k * n + k - 1] * t[(k - 1) * n + k]
    p = 0.5 * (t[(k - 1) * (n + 1)] - t[k * (n + 1)])
    q = p * p + w
    if q < 0.0:
        return
    z = p + math.sqrt(q) if p >= 0.0 else p - math.sqrt(q)
    x = t[k * n + k - 1]
    r = math.sqrt(x * x + z * z)
    p, q = x / r, z / r
    for j in range(k - 1, n):
        z, x = t[(k - 1) * n + j], t[k * n + j]
        t[(k - 1) * n + j], t[k * n + j] = q * z + p * x, q * x - p * z
    for i in range(k + 1):
        z, x = t[i * n + k - 1], t[i * n + k]
        t[i * n + k - 1], t[i * n + k] = q * z + p * x, q * x - p * z
    for i in range(n):
        z, x = v[i * n + k - 1], v[i * n + k]
        v[i * n + k - 1], v[i * n + k] = q * z + p * x, q * x - p * z
    t[k * n + k - 1] = 0.0


@rare
def _start(
    t: np.ndarray, n: int, first: int, end: int, x: float, y: float, w: float
) -> tuple[int, float, float, float]:
    """Row at which a step begins, and its first column."""
    m, p, q, r = end - 2, 0.0, 0.0, 0.0
    while m >= first:
        z = t[m * (n + 1)]
        r, s = x - z, y - z
        p = (r * s - w) / t[(m + 1) * n + m] + t[m * n + m + 1]
        q, r = t[(m + 1) * (n + 1)] - z - r - s, t[(m + 2) * n + m + 1]
        s = abs(p) + abs(q) + abs(r)
        p, q, r = p / s, q / s, r / s
        if m == first:
            break
        near = abs(t[(m - 1) * (n + 1)]) + abs(z) + abs(t[(m + 1) * (n + 1)])
        if abs(t[m * n + m - 1]) * (abs(q) + abs(r)) < _ROUNDED * abs(p) * near:
            break
        m -= 1
    for i in range(m + 2, end + 1):
        t[i * n + i - 2] = 0.0
        if i > m + 2:
            t[i * n + i - 3] = 0.0
    return m, p, q, r


@rare
def _reflect(
    t: np.ndarray, v: np.ndarray, n: int, k: int, end: int, p: float, q: float, r: float, s: float
) -> None:
    """Reflect rows and columns k ... k + 2, or k + 1 at the end; s is the size of (p, q, r)."""
    three = k != end - 1
    p += s
    x, y, z = p / s, q / s, r / s
    q, r = q / p, r / p
    above, below = t[k * n : (k + 1) * n], t[(k + 1) * n : (k + 2) * n]
    if three:
        last = t[(k + 2) * n : (k + 3) * n]
        for j in range(k, n):
            p = above[j] + q * below[j] + r * last[j]
            above[j] -= p * x
            below[j] -= p * y
            last[j] -= p * z
    else:
        for j in range(k, n):
            p = above[j] + q * below[j]
            above[j] -= p * x
            below[j] -= p * y
    _reflect_columns(t, n, k, min(end, k + 3) + 1, x, y, z, q, r, three)
    _reflect_columns(v, n, k, n, x, y, z, q, r, three)


@rare
def _reflect_columns(
    a: np.ndarray, n: int, k: int, rows: int, x: float, y: float, z: float, q: float, r: float,
    three: bool,
) -> None:  # fmt: skip
    for i in range(rows):
        at = i * n + k
        if three:
            p = x * a[at] + y * a[at + 1] + z * a[at + 2]
            a[at + 2] -= p * r
        else:
            p = x * a[at] + y * a[at + 1]
        a[at] -= p
        a[at + 1] -= p * q


@rare
def _step(
    t: np.ndarray, v: np.ndarray, n: int, first: int, end: int, x: float, y: float, w: float
) -> None:
    """One QR step of rows first ... end, with shifts of the sum x + y and the product x y - w."""
    m, p, q, r = _start(t, n, first, end, x, y, w)
    for k in range(m, end):
        three = k != end - 1
        size = 1.0
        if k != m:
            p, q, r = t[k * n + k - 1], t[(k + 1) * n + k - 1], 0.0
            if three:
                r = t[(k + 2) * n + k - 1]
            size = abs(p) + abs(q) + abs(r)
            if size == 0.0:
                continue
            p, q, r = p / size, q / size, r / size
        s = math.sqrt(p * p + q * q + r * r)
        if p < 0.0:
            s = -s
        if s == 0.0:
            continue
        if k != m:
            t[k * n + k - 1] = -s * size
            t[(k + 1) * n + k - 1] = 0.0
            if three:
                t[(k + 2) * n + k - 1] = 0.0
        elif first != m:
            t[k * n + k - 1] = -t[k * n + k - 1]
        _reflect(t, v, n, k, end, p, q, r, s)


@rare
def schur(t: np.ndarray, v: np.ndarray, n: int) -> bool:
    """Replace a Hessenberg matrix by its real Schur form, and v by v times what does it.

    Blocks of two rows have complex eigenvalues. False if the iteration does not end.
    """
    norm = 0.0
    for i in range(n):
        for j in range(max(i - 1, 0), n):
            norm += abs(t[i * n + j])
    end, count = n - 1, 0
    while end >= 0:
        first = _small(t, n, end, norm)
        if first >= end - 1:
            if first == end - 1:
                _split(t, v, n, end)
            end, count = first - 1, 0
            continue
        x, y = t[end * (n + 1)], t[(end - 1) * (n + 1)]
        w = t[end * n + end - 1] * t[(end - 1) * n + end]
        count += 1
        if count == _ITERATIONS:
            return False
        if count % _EXCEPTIONAL == 0:
            s = abs(t[end * n + end - 1]) + abs(t[(end - 1) * n + end - 2])
            x = y = 0.75 * s + x
            w = -0.4375 * s * s
        _step(t, v, n, first, end, x, y, w)
    return True

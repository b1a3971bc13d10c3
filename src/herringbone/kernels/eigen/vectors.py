"""Modes of a real matrix: eigenvalues, eigenvectors and the inverse of these.

One of each pair of conjugate modes is kept: with its eigenvalue a + i b and its vector g + i h, the
columns g and h of `shapes` span what moves, and x = Re((g + i h) q) with q' = (a + i b) q, where
the rows of `back` give the real part of q, and the negative of its imaginary part. A real
eigenvalue has one column. Matrices lie by rows in flat arrays.
"""

import math

import numpy as np

from herringbone.kernels.compiling.jit import rare
from herringbone.kernels.eigen.hessenberg import balance, reduce
from herringbone.kernels.eigen.schur import schur

_SMALLEST = 1e-300


def room(n: int) -> int:
    """Length of the room that `modes` needs."""
    return 2 * n * n + 6 * n


@rare
def _divide(a: float, b: float, c: float, d: float) -> tuple[float, float]:
    """(a + i b) / (c + i d)."""
    per = 1.0 / max(c * c + d * d, _SMALLEST)
    return (a * c + b * d) * per, (b * c - a * d) * per


@rare
def _null_vector(
    t: np.ndarray, x: np.ndarray, y: np.ndarray, n: int, k: int, a: float, b: float
) -> None:
    """Vector x + i y of the Schur form at the eigenvalue a + i b of the block that ends at row k.

    From below, by blocks.
    """
    for i in range(n):
        x[i], y[i] = 0.0, 0.0
    x[k] = 1.0
    i = k - 1
    if b != 0.0:
        x[i], y[i] = (a - t[k * (n + 1)]) / t[k * n + i], b / t[k * n + i]
        i -= 1
    while i >= 0:
        right, under = 0.0, 0.0
        for j in range(i + 1, k + 1):
            right -= t[i * n + j] * x[j]
            under -= t[i * n + j] * y[j]
        if i == 0 or t[i * n + i - 1] == 0.0:
            x[i], y[i] = _divide(right, under, t[i * (n + 1)] - a, -b)
            i -= 1
            continue
        above, beyond = 0.0, 0.0
        for j in range(i + 1, k + 1):
            above -= t[(i - 1) * n + j] * x[j]
            beyond -= t[(i - 1) * n + j] * y[j]
        p, q = t[(i - 1) * (n + 1)] - a, t[i * (n + 1)] - a
        up, down = t[(i - 1) * n + i], t[i * n + i - 1]
        real, imag = p * q - b * b - up * down, -b * (p + q)
        x[i - 1], y[i - 1] = _divide(
            above * q + beyond * b - up * right, beyond * q - above * b - up * under, real, imag
        )
        x[i], y[i] = _divide(
            right * p + under * b - down * above, under * p - right * b - down * beyond, real, imag
        )
        i -= 2


@rare
def _exchange(a: np.ndarray, n: int, row: int, other: int) -> None:
    """Exchange two rows."""
    for j in range(n):
        a[row * n + j], a[other * n + j] = a[other * n + j], a[row * n + j]


@rare
def invert(a: np.ndarray, inverse: np.ndarray, n: int) -> bool:
    """Write the inverse of a matrix, which is destroyed; False if there is none."""
    for i in range(n * n):
        inverse[i] = 0.0
    for i in range(n):
        inverse[i * n + i] = 1.0
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(a[i * n + k]) > abs(a[best * n + k]):
                best = i
        if not abs(a[best * n + k]) > 0.0:
            return False
        _exchange(a, n, k, best)
        _exchange(inverse, n, k, best)
        per = 1.0 / a[k * n + k]
        for j in range(n):
            a[k * n + j] *= per
            inverse[k * n + j] *= per
        for i in range(n):
            by = a[i * n + k]
            if i != k and by != 0.0:
                for j in range(k, n):
                    a[i * n + j] -= by * a[k * n + j]
                for j in range(n):
                    inverse[i * n + j] -= by * inverse[k * n + j]
    return True


@rare
def sort(a: np.ndarray, order: np.ndarray, sizes: np.ndarray, room: np.ndarray, n: int) -> None:
    """Sort rows and columns of a matrix (n, n) by size, the largest first.

    Reflections err in each row by a share of the largest one that stands below it (N. J. Higham,
    Accuracy and Stability of Numerical Algorithms, 2nd edition, 2002, section 19.4). Small rows
    hold slow modes, of which static deflections are made.

    Args:
        a: matrix, balanced.
        order: (n,) written: which row was where each one is.
        sizes: (n,) room.
        room: (n, n).
        n: rows.
    """
    for i in range(n):
        order[i], sizes[i] = i, 0.0
        for j in range(n):
            room[i * n + j] = a[i * n + j]
            sizes[i] += abs(a[i * n + j]) + abs(a[j * n + i])
    for i in range(n):
        best = i
        for j in range(i + 1, n):
            if sizes[int(order[j])] > sizes[int(order[best])]:
                best = j
        order[i], order[best] = order[best], order[i]
    for i in range(n):
        row = int(order[i]) * n
        for j in range(n):
            a[i * n + j] = room[row + int(order[j])]


@rare
def modes(
    a: np.ndarray, real: np.ndarray, imag: np.ndarray, shapes: np.ndarray, back: np.ndarray,
    w: np.ndarray, n: int,
) -> int:  # fmt: skip
    """Find the modes of a matrix (n, n), which is destroyed.

    Args:
        a: matrix.
        real, imag: for the eigenvalues, imag >= 0.
        shapes: (n, n) for their vectors.
        back: (n, n) for the inverse of `shapes`.
        w: `room`.
        n: rows.

    Returns:
        How many modes there are; -1 if they are not found.
    """
    v, copy = w[: n * n], w[n * n : 2 * n * n]
    rest = w[2 * n * n :]
    scale, x, y, u = rest[:n], rest[n : 2 * n], rest[2 * n : 3 * n], rest[3 * n : 5 * n]
    order = rest[5 * n : 6 * n]
    balance(a, scale, n)
    sort(a, order, x, copy, n)
    reduce(a, v, u, n)
    if not schur(a, v, n):
        return -1
    count, k = 0, 0
    while k < n:
        pair = k + 1 < n and a[(k + 1) * n + k] != 0.0
        real[count], imag[count] = a[k * (n + 1)], 0.0
        if pair:
            p = 0.5 * (a[k * (n + 1)] - a[(k + 1) * (n + 1)])
            real[count] = a[(k + 1) * (n + 1)] + p
            imag[count] = math.sqrt(abs(p * p + a[(k + 1) * n + k] * a[k * n + k + 1]))
        end = k + 1 if pair else k
        _null_vector(a, x, y, n, end, real[count], imag[count])
        for i in range(n):
            g, h = 0.0, 0.0
            for j in range(end + 1):
                g += v[i * n + j] * x[j]
                h += v[i * n + j] * y[j]
            row = int(order[i])
            shapes[row * n + k] = scale[row] * g
            if pair:
                shapes[row * n + k + 1] = scale[row] * h
        count, k = count + 1, end + 1
    for i in range(n):
        per = 1.0 / scale[i]
        for j in range(n):
            copy[i * n + j] = per * shapes[i * n + j]
    if not invert(copy, back, n):
        return -1
    for i in range(n):
        for j in range(n):
            back[i * n + j] /= scale[j]
    return count

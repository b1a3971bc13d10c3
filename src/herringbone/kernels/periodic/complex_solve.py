"""Linear equations with complex numbers, in the kernel language: two arrays, real and imaginary."""

import numpy as np

from herringbone.kernels.compiling.jit import kernel


@kernel
def _pivot(re: np.ndarray, im: np.ndarray, k: int, n: int) -> int:
    """Row of the largest entry of a column, from the diagonal on."""
    best, row = -1.0, k
    for i in range(k, n):
        size = abs(re[i * n + k]) + abs(im[i * n + k])
        if size > best:
            best, row = size, i
    return row


@kernel
def _eliminate(
    re: np.ndarray, im: np.ndarray, x: np.ndarray, y: np.ndarray, k: int, i: int, n: int
) -> None:
    """Subtract a multiple of row k from row i, so that the entry below the diagonal vanishes."""
    pr, pi = re[k * n + k], im[k * n + k]
    ar, ai = re[i * n + k], im[i * n + k]
    size = pr * pr + pi * pi
    fr, fi = (ar * pr + ai * pi) / size, (ai * pr - ar * pi) / size
    upper_re, upper_im = re[k * n : (k + 1) * n], im[k * n : (k + 1) * n]
    row_re, row_im = re[i * n : (i + 1) * n], im[i * n : (i + 1) * n]
    for j in range(k + 1, n):
        row_re[j] -= fr * upper_re[j] - fi * upper_im[j]
        row_im[j] -= fr * upper_im[j] + fi * upper_re[j]
    xk, yk = x[k], y[k]
    x[i] -= fr * xk - fi * yk
    y[i] -= fr * yk + fi * xk


@kernel
def complex_solve(re: np.ndarray, im: np.ndarray, x: np.ndarray, y: np.ndarray, n: int) -> None:
    """Solve (re + i im) z = x + i y for z (n,) by elimination with row pivoting.

    Args:
        re, im: matrix (n, n), row after row; destroyed. Must be regular.
        x, y: right-hand side; replaced by the solution.
        n: number of unknowns.
    """
    for k in range(n):
        row = _pivot(re, im, k, n)
        if row != k:
            for j in range(k, n):
                a, b = k * n + j, row * n + j
                re[a], re[b] = re[b], re[a]
                im[a], im[b] = im[b], im[a]
            x[k], x[row] = x[row], x[k]
            y[k], y[row] = y[row], y[k]
        for i in range(k + 1, n):
            if re[i * n + k] != 0.0 or im[i * n + k] != 0.0:
                _eliminate(re, im, x, y, k, i, n)
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            ar, ai = re[k * n + j], im[k * n + j]
            xj, yj = x[j], y[j]
            x[k] -= ar * xj - ai * yj
            y[k] -= ar * yj + ai * xj
        pr, pi = re[k * n + k], im[k * n + k]
        size = pr * pr + pi * pi
        x[k], y[k] = (x[k] * pr + y[k] * pi) / size, (y[k] * pr - x[k] * pi) / size

"""Balance of a real matrix, and its Hessenberg form.

B. T. Smith et al., Matrix Eigensystem Routines: EISPACK Guide, 1976: balanc, orthes and ortran.
Matrices (n, n) lie by rows in flat arrays.
"""

import math

import numpy as np

from herringbone.kernels.compiling.jit import rare

_RADIX = 2.0
_BALANCED = 0.95
_ROUNDS = 50


@rare
def balance(a: np.ndarray, scale: np.ndarray, n: int) -> None:
    """Replace `a` by D^-1 a D whose rows and columns are alike in size; `scale` (n,) is D."""
    for i in range(n):
        scale[i] = 1.0
    for _ in range(_ROUNDS):
        done = True
        for i in range(n):
            column, row = 0.0, 0.0
            for j in range(n):
                if j != i:
                    column += abs(a[j * n + i])
                    row += abs(a[i * n + j])
            if column == 0.0 or row == 0.0:
                continue
            f, total = 1.0, column + row
            while column < row / _RADIX:
                f, column = f * _RADIX, column * _RADIX * _RADIX
            while column >= row * _RADIX:
                f, column = f / _RADIX, column / (_RADIX * _RADIX)
            if (column + row) / f < _BALANCED * total:
                done = False
                scale[i] *= f
                for j in range(n):
                    a[i * n + j] /= f
                for j in range(n):
                    a[j * n + i] *= f
        if done:
            return


@rare
def reduce(a: np.ndarray, v: np.ndarray, u: np.ndarray, n: int) -> None:
    """Replace `a` by its Hessenberg form v^T a v, v orthogonal.

    Args:
        a: matrix.
        v: for v.
        u: (2 n,) room.
        n: rows.
    """
    for i in range(n * n):
        v[i] = 0.0
    for i in range(n):
        v[i * n + i] = 1.0
    sums = u[n:]
    for m in range(1, n - 1):
        size = 0.0
        for i in range(m, n):
            u[i] = a[i * n + m - 1]
            size += u[i] * u[i]
        if size == 0.0:
            continue
        g = math.sqrt(size)
        if u[m] > 0.0:
            g = -g
        per = 1.0 / (size - u[m] * g)
        u[m] -= g
        for j in range(m - 1, n):
            sums[j] = 0.0
        for i in range(m, n):
            row, by = a[i * n : (i + 1) * n], u[i]
            for j in range(m - 1, n):
                sums[j] += by * row[j]
        for i in range(m, n):
            row, by = a[i * n : (i + 1) * n], per * u[i]
            for j in range(m - 1, n):
                row[j] -= by * sums[j]
        _from_the_right(a, u, m, n, per)
        _from_the_right(v, u, m, n, per)
        for i in range(m + 1, n):
            a[i * n + m - 1] = 0.0


@rare
def _from_the_right(a: np.ndarray, u: np.ndarray, m: int, n: int, per: float) -> None:
    """Multiply by 1 - per u u^T from the right; u begins at m."""
    for i in range(n):
        row, total = a[i * n : (i + 1) * n], 0.0
        for j in range(m, n):
            total += row[j] * u[j]
        total *= per
        for j in range(m, n):
            row[j] -= total * u[j]

"""Small linear algebra in flat arrays."""

import numpy as np

from herringbone.kernels.compiling.jit import kernel


@kernel
def add_columns(
    matrix: np.ndarray, stride: int, values: np.ndarray, count: int, to: np.ndarray, rows: int
) -> None:
    """Add a matrix, by columns that are `stride` apart, times `count` values to `to` (rows,)."""
    whole = count - count % 4
    for i in range(0, whole, 4):
        a, b, c, d = values[i], values[i + 1], values[i + 2], values[i + 3]
        if a == 0.0 and b == 0.0 and c == 0.0 and d == 0.0:
            continue
        first = matrix[i * stride : i * stride + rows]
        second = matrix[(i + 1) * stride : (i + 1) * stride + rows]
        third = matrix[(i + 2) * stride : (i + 2) * stride + rows]
        fourth = matrix[(i + 3) * stride : (i + 3) * stride + rows]
        for row in range(rows):
            to[row] += first[row] * a + second[row] * b + (third[row] * c + fourth[row] * d)
    for i in range(whole, count):
        a, first = values[i], matrix[i * stride : i * stride + rows]
        for row in range(rows):
            to[row] += first[row] * a


@kernel
def solve(a: np.ndarray, r: np.ndarray, n: int) -> None:
    """Solve a x = r (n, n) by elimination without pivots, for a matrix near 1; x in `r`."""
    for k in range(n):
        per, right = 1.0 / a[k * n + k], r[k]
        for i in range(k + 1, n):
            factor = a[i * n + k] * per
            if factor != 0.0:
                for j in range(k + 1, n):
                    a[i * n + j] -= factor * a[k * n + j]
                r[i] -= factor * right
    for back in range(n):
        k = n - 1 - back
        total = r[k]
        for j in range(k + 1, n):
            total -= a[k * n + j] * r[j]
        r[k] = total / a[k * n + k]

"""Modal coordinates over a step: rows of what is wanted, and the coordinates themselves.

Matrices are stored with the coordinates (or the inputs) first, so that the innermost loops go side
by side over rows, several columns at once, and no sum changes its order.
"""

import numpy as np

from herringbone.kernels.compiling.jit import hot, kernel


@kernel
def copy(values: np.ndarray, to: np.ndarray) -> None:
    """Write the values to an array of the same length."""
    for i in range(to.size):
        to[i] = values[i]


@hot
def add_product(matrix: np.ndarray, values: np.ndarray, to: np.ndarray) -> None:
    """Add matrix (values, rows) times the values to `to` (rows,), eight at once."""
    n, rows = values.size, to.size
    whole = n - n % 8
    for i in range(0, whole, 8):
        a, b, c, d = values[i], values[i + 1], values[i + 2], values[i + 3]
        e, f, g, h = values[i + 4], values[i + 5], values[i + 6], values[i + 7]
        of_a, of_b, of_c, of_d = matrix[i], matrix[i + 1], matrix[i + 2], matrix[i + 3]
        of_e, of_f, of_g, of_h = matrix[i + 4], matrix[i + 5], matrix[i + 6], matrix[i + 7]
        for row in range(rows):
            first = (of_a[row] * a + of_b[row] * b) + (of_c[row] * c + of_d[row] * d)
            second = (of_e[row] * e + of_f[row] * f) + (of_g[row] * g + of_h[row] * h)
            to[row] += first + second
    if n - whole >= 4:
        i = whole
        a, b, c, d = values[i], values[i + 1], values[i + 2], values[i + 3]
        of_a, of_b, of_c, of_d = matrix[i], matrix[i + 1], matrix[i + 2], matrix[i + 3]
        for row in range(rows):
            to[row] += (of_a[row] * a + of_b[row] * b) + (of_c[row] * c + of_d[row] * d)
        whole += 4
    for i in range(whole, n):
        a, of_a = values[i], matrix[i]
        for row in range(rows):
            to[row] += of_a[row] * a


@hot
def add_chosen(
    matrix: np.ndarray, values: np.ndarray, chosen: np.ndarray, count: int, to: np.ndarray
) -> None:
    """As `add_product`, of the first `count` chosen values; the others are zero."""
    rows = to.size
    whole = count - count % 4
    for k in range(0, whole, 4):
        i, j, m, n = chosen[k], chosen[k + 1], chosen[k + 2], chosen[k + 3]
        a, b, c, d = values[i], values[j], values[m], values[n]
        of_a, of_b, of_c, of_d = matrix[i], matrix[j], matrix[m], matrix[n]
        for row in range(rows):
            to[row] += of_a[row] * a + of_b[row] * b + (of_c[row] * c + of_d[row] * d)
    for k in range(whole, count):
        a, of_a = values[chosen[k]], matrix[chosen[k]]
        for row in range(rows):
            to[row] += of_a[row] * a


@kernel
def turn(real: np.ndarray, imag: np.ndarray, q: np.ndarray) -> None:
    """Multiply coordinates by the factors of the modes; q: all real parts, then the imaginary."""
    modes = real.size
    x, y = q[:modes], q[modes : 2 * modes]
    for mode in range(modes):
        a, b = x[mode], y[mode]
        x[mode] = real[mode] * a - imag[mode] * b
        y[mode] = real[mode] * b + imag[mode] * a


@kernel
def solve(a: np.ndarray, r: np.ndarray) -> None:
    """Solve a x = r by elimination without pivots, for a matrix near the identity; x in `r`.

    Of `a` as many rows and columns are used as `r` has.
    """
    n = r.size
    for k in range(n):
        pivot = a[k]
        per = 1.0 / pivot[k]
        right = r[k]
        for i in range(k + 1, n):
            row = a[i]
            factor = row[k] * per
            if factor != 0.0:
                for j in range(k + 1, n):
                    row[j] -= factor * pivot[j]
                r[i] -= factor * right
    for back in range(n):
        k = n - 1 - back
        row = a[k]
        total = r[k]
        for j in range(k + 1, n):
            total -= row[j] * r[j]
        r[k] = total / row[k]

"""Modal coordinates over a step: rows of what is wanted, and the coordinates themselves.

Matrices are stored with the modes (or the inputs) first, so that the innermost loops go side by
side over rows or modes, and no sum changes its order.
"""

import numpy as np

from herringbone.kernels.compiling.jit import kernel


@kernel
def copy(values: np.ndarray, to: np.ndarray) -> None:
    """Write the values to an array of the same length."""
    for i in range(to.size):
        to[i] = values[i]


@kernel
def fill(to: np.ndarray, value: float) -> None:
    """Write one value everywhere."""
    for i in range(to.size):
        to[i] = value


@kernel
def add_rows(
    real: np.ndarray, imag: np.ndarray, x: np.ndarray, y: np.ndarray, to: np.ndarray
) -> None:
    """Add the real part of matrix times coordinates x + i y to `to`; matrix (modes, rows)."""
    for mode in range(x.size):
        a, b = x[mode], y[mode]
        re, im = real[mode], imag[mode]
        for row in range(to.size):
            to[row] += re[row] * a - im[row] * b


@kernel
def add_inputs(matrix: np.ndarray, values: np.ndarray, first: int, to: np.ndarray) -> None:
    """Add matrix (inputs, rows), from input `first` on, times the values to `to`."""
    for i in range(first, values.size):
        value = values[i]
        if value != 0.0:
            column = matrix[i]
            for row in range(to.size):
                to[row] += column[row] * value


@kernel
def turn(real: np.ndarray, imag: np.ndarray, x: np.ndarray, y: np.ndarray) -> None:
    """Multiply the coordinates x + i y by the factors of the modes."""
    for mode in range(x.size):
        a, b = x[mode], y[mode]
        x[mode] = real[mode] * a - imag[mode] * b
        y[mode] = real[mode] * b + imag[mode] * a


@kernel
def solve(a: np.ndarray, r: np.ndarray) -> None:
    """Solve a x = r by elimination without pivots, for a matrix near the identity; x in `r`."""
    n = r.size
    for k in range(n):
        per = 1.0 / a[k, k]
        for i in range(k + 1, n):
            factor = a[i, k] * per
            if factor != 0.0:
                for j in range(k + 1, n):
                    a[i, j] -= factor * a[k, j]
                r[i] -= factor * r[k]
    for back in range(n):
        k = n - 1 - back
        total = r[k]
        for j in range(k + 1, n):
            total -= a[k, j] * r[j]
        r[k] = total / a[k, k]

"""Polynomial coupling signals: values at equidistant nodes of a macro step.

A signal of degree d is given by its values at c = 0, 1/d, ..., 1; in the block they lie side by
side (value, node 1 ... node d). Degree 0 holds the value.
"""

import numpy as np

from herringbone.core.declaring.variable import NODES
from herringbone.kernels.compiling.jit import kernel

STRIDE = NODES + 1


@kernel
def monomial(values: np.ndarray, at: int, degree: int, out: np.ndarray, to: int) -> None:
    """Coefficients of c**0 ... c**degree of the signal at `values[at:]`, written to `out[to:]`.

    Newton's forward differences on the variable degree * c, expanded by Horner's rule.
    """
    for j in range(STRIDE):
        out[to + j] = values[at + j] if j <= degree else 0.0
    for order in range(1, degree + 1):
        for j in range(degree, order - 1, -1):
            out[to + j] = (out[to + j] - out[to + j - 1]) / order
    for root in range(degree - 2, -1, -1):
        for j in range(root + 1, degree):
            out[to + j] -= (root + 1.0) * out[to + j + 1]
    scale = 1.0
    for j in range(1, degree + 1):
        scale *= degree
        out[to + j] *= scale


@kernel
def evaluate(coefficients: np.ndarray, at: int, degree: int, c: float) -> float:
    """Value at c of the polynomial with coefficients at `coefficients[at:]`."""
    value = coefficients[at + degree]
    for j in range(degree - 1, -1, -1):
        value = value * c + coefficients[at + j]
    return value


@kernel
def shift(coefficients: np.ndarray, at: int, degree: int, start: float, width: float) -> None:
    """Re-expand in place, so that the new variable is (c - start) / width."""
    for k in range(degree):
        for j in range(degree - 1, k - 1, -1):
            coefficients[at + j] += start * coefficients[at + j + 1]
    scale = 1.0
    for j in range(1, degree + 1):
        scale *= width
        coefficients[at + j] *= scale


@kernel
def store_node(b: np.ndarray, first: int, count: int, node: int) -> None:
    """Copy the present values of `count` signals to their node."""
    for i in range(count):
        b[first + i * STRIDE + node] = b[first + i * STRIDE]


@kernel
def all_finite(b: np.ndarray, first: int, count: int) -> bool:
    """True if no value of a range is NaN or infinite."""
    bad = 0
    for i in range(first, first + count):  # to the end, so that several are looked at together
        bad |= b[i] - b[i] != 0.0
    return bad == 0

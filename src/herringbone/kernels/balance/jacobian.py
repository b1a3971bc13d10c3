"""The Jacobian of harmonic balance: products of periodic tangents with harmonics, as real matrices.

A real signal of period 2 pi / w has coefficients c_k, k = 0 ... n: the sum of c_k exp(i k w t) over
all k, with c_-k the conjugate of c_k. Its real form is Re c_0 ... Re c_n, Im c_1 ... Im c_n.
"""

import numpy as np

from herringbone.kernels.compiling.jit import kernel


@kernel
def fill_jacobian(
    bends: np.ndarray, of: np.ndarray, along: np.ndarray, order: int, jacobian: np.ndarray
) -> None:
    """Write I - B G: how residuals of unknown signals depend on them.

    B multiplies by tangents in time, G is a linear answer in frequency.

    Args:
        bends: (tangents, more than 2 n) coefficients c_k of what the tangents are off their means.
        of: (tangents,) the unknown that each is of; -1: none.
        along: (tangents, unknowns, n + 1) what each tangent is along, by coefficients of unknowns.
        order: n.
        jacobian: (unknowns (2 n + 1), the same); written.
    """
    size = 2 * order + 1
    for i in range(len(jacobian)):
        for j in range(len(jacobian)):
            jacobian[i, j] = 0.0
        jacobian[i, i] = 1.0
    for t in range(of.size):
        if of[t] < 0:
            continue
        first = of[t] * size
        for unknown in range(along.shape[1]):
            column = unknown * size
            for m in range(order + 1):
                g = along[t, unknown, m]
                if g == 0.0:
                    continue
                for k in range(order + 1):
                    plus = bends[t, k + m] * np.conj(g)
                    minus = (bends[t, k - m] if k >= m else np.conj(bends[t, m - k])) * g
                    if m == 0:
                        jacobian[first + k, column] -= minus.real
                        if k > 0:
                            jacobian[first + order + k, column] -= minus.imag
                        continue
                    sum_, difference = minus + plus, minus - plus
                    jacobian[first + k, column + m] -= sum_.real
                    jacobian[first + k, column + order + m] += difference.imag
                    if k > 0:
                        jacobian[first + order + k, column + m] -= sum_.imag
                        jacobian[first + order + k, column + order + m] -= difference.real

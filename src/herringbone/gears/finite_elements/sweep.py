r"""Compliance of a stack of equal layers by block elimination along the face width.

The stiffness matrix of the stack is block tridiagonal, with one block per section.  With its
Cholesky factor L, a compliance F^T K^-1 F is Y^T Y with L Y = F: forward elimination alone, section
by section,

    S_0 = A,   S_k = L_k L_k^T,   X_k = L_k^-1 B,   S_k+1 = A + C - X_k^T X_k,
    Y_k = L_k^-1 (F_k - X_k-1^T Y_k-1),

A, B, C being the blocks of one layer.  Two sections are in memory at a time, whatever the number of
layers.  (G. H. Golub and C. F. Van Loan, Matrix Computations, 4th edition, 4.5.1.)
"""

from collections.abc import Callable

import numpy as np
from scipy.linalg import cholesky, solve_triangular
from scipy.linalg.blas import dsyrk

from herringbone.gears.finite_elements.layer import Layer


def stack_compliance(
    layer: Layer,
    layers: int,
    loads: np.ndarray,
    measures: np.ndarray,
    progress: Callable[[float], None] = lambda done: None,
) -> np.ndarray:
    """Displacement that each measure sees under each load.

    Args:
        layer: stiffness of one layer.
        layers: number of layers.
        loads: the same unit loads for every section, shape (n, q) [1].
        measures: the same weights of displacements for every section, shape (n, r) [1].
        progress: called after each section with the share done.

    Returns:
        Shape (sections, r, sections, q) [m/N]: section and measure, section and load.
    """
    q, r, sections = loads.shape[1], measures.shape[1], layers + 1
    block = layer.lower
    pushed, seen = np.zeros((len(block), 0)), np.zeros((len(block), 0))
    found = np.zeros((r * sections, q * sections))
    for k in range(sections):
        factor = cholesky(block, lower=True, check_finite=False)
        pushed = _solved(factor, np.hstack([pushed, loads]))
        seen = _solved(factor, np.hstack([seen, measures]))
        found[: seen.shape[1], : pushed.shape[1]] += seen.T @ pushed
        if k < layers:
            step = _solved(factor, layer.coupling)
            block = layer.upper if k == layers - 1 else layer.upper + layer.lower
            block = block - _square(step)
            pushed, seen = -step.T @ pushed, -step.T @ seen
        progress((k + 1) / sections)
    return found.reshape(sections, r, sections, q)


def _solved(factor: np.ndarray, right: np.ndarray) -> np.ndarray:
    return solve_triangular(factor, right, lower=True, check_finite=False)


def _square(factor: np.ndarray) -> np.ndarray:
    """factor^T factor, symmetric."""
    half = dsyrk(1.0, factor, trans=1, lower=1)
    return half + np.tril(half, -1).T

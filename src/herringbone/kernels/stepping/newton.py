"""Damped Newton for a few dozen equations, in the kernel language.

Unknowns are scaled by their sizes, rows by their largest entry in the Jacobian, which is made of
forward differences. What the equations leave open, such as a tooth in its backlash or a mode that
is not in use, stays where the search began: elimination with full pivoting, which stops at pivots
that are small against the first one (G. H. Golub and C. F. Van Loan, Matrix Computations, 2013,
section 3.4).
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from herringbone.kernels.compiling.jit import inner, kernel
from herringbone.kernels.stepping.local_error import worse

SETTLED = 0
NOT_FOUND = 1
_ITERATIONS, _HALVINGS, _PATIENCE = 60, 12, 15
_CLOSER = 0.9
_CONVERGED = 1e-11
_DIFFERENCE = 1e-3
_RANK = 1e-12
_VECTORS = 5


def newton_scratch(count: int) -> int:
    """Length of the scratch space for so many unknowns."""
    return count * (count + _VECTORS)


@kernel
def _exchange(a: np.ndarray, first: int, second: int, stride: int, count: int) -> None:
    """Exchange two rows or columns of a matrix."""
    for k in range(count):
        i, j = first + k * stride, second + k * stride
        a[i], a[j] = a[j], a[i]


@kernel
def _pivot(a: np.ndarray, k: int, n: int) -> tuple[int, int]:
    """Row and column of the largest entry of what is left."""
    best, row, column = 0.0, k, k
    for i in range(k, n):
        for j in range(k, n):
            if abs(a[i * n + j]) > best:
                best, row, column = abs(a[i * n + j]), i, j
    return row, column


@kernel
def solve(a: np.ndarray, r: np.ndarray, order: np.ndarray, x: np.ndarray, n: int) -> None:
    """Solve a x = r (n, n) for x; unknowns without a pivot are 0. Destroys `a` and `r`."""
    rank, largest = n, 0.0
    for i in range(n):
        order[i] = i
        x[i] = 0.0
    for k in range(n):
        row, column = _pivot(a, k, n)
        best = abs(a[row * n + column])
        if k == 0:
            largest = best
        if best <= _RANK * largest:
            rank = k
            break
        _exchange(a, k * n, row * n, 1, n)
        _exchange(a, k, column, n, n)
        r[k], r[row] = r[row], r[k]
        order[k], order[column] = order[column], order[k]
        for i in range(k + 1, n):
            factor = a[i * n + k] / a[k * n + k]
            if factor != 0.0:
                for j in range(k + 1, n):
                    a[i * n + j] -= factor * a[k * n + j]
                r[i] -= factor * r[k]
    for k in range(rank - 1, -1, -1):
        for j in range(k + 1, rank):
            r[k] -= a[k * n + j] * r[j]
        r[k] /= a[k * n + k]
    for k in range(rank):
        x[int(order[k])] = r[k]


@kernel
def _norm(r: np.ndarray, rows: np.ndarray, n: int) -> float:
    """Sum of the squares of scaled residuals."""
    total = 0.0
    for i in range(n):
        total += (r[i] / rows[i]) * (r[i] / rows[i])
    return total


@kernel
def _largest(r: np.ndarray, rows: np.ndarray, n: int) -> float:
    found = 0.0
    for i in range(n):
        found = worse(found, abs(r[i] / rows[i]))
    return found


class _Equations(NamedTuple):
    """What is asked of `newton_solver`."""

    residual: Callable[[np.ndarray, float, np.ndarray], None]
    unknowns: tuple[int, ...]
    sizes: tuple[float, ...]
    scratch: int
    owner: str


def newton_solver(
    residual: Callable[[np.ndarray, float, np.ndarray], None],
    unknowns: tuple[int, ...],
    sizes: tuple[float, ...],
    scratch: int,
    owner: str,
) -> Callable[[np.ndarray, float], int]:
    """Compile a search for the zero of a residual.

    Args:
        residual: residual(b, t, r) writes as many numbers as there are unknowns.
        unknowns: their indices in the block.
        sizes: their usual sizes.
        scratch: index in the block of `newton_scratch` numbers.
        owner: name of the component, for messages.

    Returns:
        search(b, t) -> int: SETTLED, or NOT_FOUND with the unknowns where the search ended.
    """
    n = len(unknowns)
    end = scratch + n * n
    equations = _Equations(residual, unknowns, sizes, scratch, owner)
    jacobian, advance = _jacobian_maker(equations), _advancer(equations)

    @inner(owner)
    def search(b: np.ndarray, t: float) -> int:
        r, rows = b[end : end + n], b[end + n : end + 2 * n]
        residual(b, t, r)
        first, best, since = 0.0, np.inf, 0
        for iteration in range(_ITERATIONS):
            jacobian(b, t)
            scaled = _largest(r, rows, n)
            if iteration == 0:
                first = max(scaled, 1.0)
            if scaled < _CONVERGED * first:
                return SETTLED
            if scaled < _CLOSER * best:
                best, since = scaled, iteration
            if iteration - since >= _PATIENCE or not scaled < np.inf:
                return NOT_FOUND
            advance(b, t)
        return NOT_FOUND

    return search


def _jacobian_maker(of: _Equations) -> Callable[[np.ndarray, float], None]:
    """Compile jacobian(b, t), beside the residual there; see `newton_solver`."""
    residual, unknowns, sizes, scratch, owner = of
    n, end = len(unknowns), scratch + len(unknowns) ** 2

    @inner(owner)
    def jacobian(b: np.ndarray, t: float) -> None:
        """Jacobian and largest entries of its rows; rows of zeros count 1."""
        a, r, rows = b[scratch:end], b[end : end + n], b[end + n : end + 2 * n]
        moved = b[end + 2 * n : end + 3 * n]
        for i in range(n):
            rows[i] = 0.0
        for j in range(n):
            kept = b[unknowns[j]]
            b[unknowns[j]] = kept + _DIFFERENCE * sizes[j]
            residual(b, t, moved)
            b[unknowns[j]] = kept
            for i in range(n):
                a[i * n + j] = (moved[i] - r[i]) / _DIFFERENCE
                rows[i] = max(rows[i], abs(a[i * n + j]))
        for i in range(n):
            if rows[i] == 0.0:
                rows[i] = 1.0

    return jacobian


def _advancer(of: _Equations) -> Callable[[np.ndarray, float], None]:
    """Compile advance(b, t), by that Jacobian; see `newton_solver`."""
    residual, unknowns, sizes, scratch, owner = of
    n, end = len(unknowns), scratch + len(unknowns) ** 2

    @inner(owner)
    def advance(b: np.ndarray, t: float) -> None:
        """A Newton step, halved until the residual falls; the last trial is taken in any case."""
        a, r, rows = b[scratch:end], b[end : end + n], b[end + n : end + 2 * n]
        trial, order = b[end + 2 * n : end + 3 * n], b[end + 3 * n : end + 4 * n]
        x = b[end + 4 * n : end + 5 * n]
        before = _norm(r, rows, n)
        for i in range(n):
            trial[i] = -r[i] / rows[i]
            for j in range(n):
                a[i * n + j] /= rows[i]
        solve(a, trial, order, x, n)
        part = 1.0
        for i in range(n):
            x[i] *= sizes[i]
            b[unknowns[i]] += x[i]
        for _ in range(_HALVINGS):
            residual(b, t, r)
            if _norm(r, rows, n) < before:
                break
            part *= 0.5
            for i in range(n):
                b[unknowns[i]] -= part * x[i]
        residual(b, t, r)

    return advance

"""One inexact step of Newton on the harmonics of a period of many meshes.

GMRES (Y. Saad and M. H. Schultz, SIAM J. Sci. Stat. Comput. 7, 1986, 856-869) on the exact
Jacobian, whose products are taken in time, behind the inverse of the mesh-periodic one.
"""

import numpy as np

from herringbone.analysis.steady.harmonic_balance.correction import bent
from herringbone.analysis.steady.harmonic_balance.families import Families
from herringbone.analysis.steady.harmonic_balance.fourier import in_frequency, in_time
from herringbone.analysis.steady.harmonic_balance.problem import Problem, Samples
from herringbone.analysis.steady.harmonic_balance.response import Response

_MOST = 40
"""Vectors of a search."""


def correct_by_families(
    problem: Problem,
    answer: Response,
    samples: Samples,
    off: np.ndarray,
    families: Families,
    close: float,
) -> np.ndarray:
    """Changes of the values (values, harmonics).

    Args:
        problem: linear part and laws.
        answer: of the linear part.
        samples: of the laws.
        off: (values, harmonics) what the laws give and the motion lacks.
        families: of the harmonics.
        close: residual of the linear equations, over that at the start, at which it ends.
    """
    found = bent(problem, samples)
    step = off.copy()
    unknown = found.unknown
    if not unknown.size:
        return step
    orders, places = answer.orders, len(samples.f)
    inverses = families.inverses(answer, found)
    gains = answer.gain(problem.along, problem.along_angle, unknown, orders.size)
    weights = [found.bends[:, found.owner == u].T for u in range(unknown.size)]
    rows = [np.flatnonzero(found.owner == u) for u in range(unknown.size)]

    def product(values: np.ndarray) -> np.ndarray:
        moved = in_time(np.einsum("tuh,uh->th", gains, values), orders, places)
        bends = [(w * moved[r]).sum(axis=0) for w, r in zip(weights, rows, strict=True)]
        return values - in_frequency(np.array(bends), orders)

    step[unknown] = gmres(product, lambda v: families.solve(inverses, v), off[unknown], close)
    return step


def gmres(product, inverse, right: np.ndarray, close: float) -> np.ndarray:  # noqa: ANN001
    """Solve A x = right for coefficients (n, harmonics) of real signals.

    Args:
        product: A times such coefficients.
        inverse: about the inverse of A, likewise.
        right: (n, harmonics).
        close: residual, over that at the start, at which it ends.
    """
    first = inverse(right)
    size = _norm(first)
    if size == 0.0 or not np.isfinite(size):
        return first
    basis = [first / size]
    matrix = np.zeros((_MOST + 1, _MOST))
    wanted = np.zeros(_MOST + 1)
    wanted[0] = size
    for k in range(_MOST):
        ahead = inverse(product(basis[k]))
        for j, vector in enumerate(basis):
            matrix[j, k] = inner(vector, ahead)
            ahead -= matrix[j, k] * vector
        matrix[k + 1, k] = _norm(ahead)
        if not np.isfinite(matrix[k + 1, k]):
            break  # no linear algebra ends on that
        shares, *_ = np.linalg.lstsq(matrix[: k + 2, : k + 1], wanted[: k + 2], rcond=None)
        left = np.linalg.norm(matrix[: k + 2, : k + 1] @ shares - wanted[: k + 2])
        if left <= close * size or matrix[k + 1, k] <= close * 1e-3:
            break
        basis.append(ahead / matrix[k + 1, k])
    return sum(share * vector for share, vector in zip(shares, basis, strict=False))


def inner(a: np.ndarray, b: np.ndarray) -> float:
    """Inner product of real signals."""
    return float(2.0 * np.vdot(a, b).real - np.vdot(a[:, 0], b[:, 0]).real)


def _norm(a: np.ndarray) -> float:
    return float(np.sqrt(inner(a, a)))

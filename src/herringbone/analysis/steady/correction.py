"""One step of Newton on the harmonics of a period of one mesh: all unknowns at once."""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.fourier import in_frequency
from herringbone.analysis.steady.problem import Problem, Samples
from herringbone.analysis.steady.response import Response
from herringbone.kernels.balance.jacobian import fill_jacobian


class Bent(NamedTuple):
    """Stiff values whose tangents are not their means, and what makes them so.

    Attributes:
        unknown: (unknowns,) indices of the values.
        owner: (tangents,) the unknown that each tangent is of; -1: none.
        bends: (places, tangents) tangents less their means.
    """

    unknown: np.ndarray
    owner: np.ndarray
    bends: np.ndarray


def bent(problem: Problem, samples: Samples) -> Bent:
    """What a step of Newton has to solve for."""
    bends = samples.k - problem.mean
    bending = bends.any(axis=0)
    unknown = np.unique(problem.owner[bending])
    place = np.full(problem.values, -1)
    place[unknown] = np.arange(unknown.size)
    return Bent(unknown, place[problem.owner], bends)


def correct_at_once(
    problem: Problem, answer: Response, samples: Samples, off: np.ndarray, order: int
) -> np.ndarray:
    """Changes of the values (values, harmonics).

    Args:
        problem: linear part and laws.
        answer: of the linear part, of all harmonics from 0 on.
        samples: of the laws.
        off: (values, harmonics) what the laws give and the motion lacks.
        order: highest harmonic that is solved for; others change by what is off.
    """
    found = bent(problem, samples)
    step = off.copy()
    if not found.unknown.size:
        return step
    n = order
    gains = answer.gain(problem.along, problem.along_angle, found.unknown, n + 1)
    size = 2 * n + 1
    jacobian = np.empty((found.unknown.size * size, found.unknown.size * size))
    products = np.ascontiguousarray(in_frequency(found.bends.T, np.arange(2 * n + 1)))
    fill_jacobian(products, found.owner, gains, n, jacobian)
    right = off[found.unknown, : n + 1]
    wanted = np.hstack([right.real, right[:, 1:].imag]).ravel()
    solved = np.linalg.solve(jacobian, wanted).reshape(found.unknown.size, size)
    step[found.unknown, : n + 1] = solved[:, : n + 1]
    step[found.unknown, 1 : n + 1] += 1j * solved[:, n + 1 :]
    return step

"""One step of Newton on the harmonics of a period of one mesh: all unknowns at once."""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.harmonic_balance.fourier import in_frequency
from herringbone.analysis.steady.harmonic_balance.problem import Problem, Samples
from herringbone.analysis.steady.harmonic_balance.response import Response
from herringbone.kernels.balance.jacobian import fill_jacobian

_STEP, _LEAST = 1e-5, 1e-10
"""Step of differences: over the range of an argument, and at least."""


class Bent(NamedTuple):
    """Stiff values whose tangents are not their means, and what makes them so.

    Attributes:
        unknown: (unknowns,) indices of the values.
        owner: (tangents,) the unknown that each tangent is of; -1: none.
        bends: (places, tangents) tangents less their means.
        along: (tangents, modes) what they are along.
        along_angle: (tangents,) how theta moves that.
    """

    unknown: np.ndarray
    owner: np.ndarray
    bends: np.ndarray
    along: np.ndarray
    along_angle: np.ndarray


def bent(problem: Problem, samples: Samples) -> Bent:
    """What a step of Newton has to solve for."""
    bends = samples.k - problem.mean
    bent_ones = bends.any(axis=0)
    unknown = problem.stiff if bent_ones.all() else np.unique(problem.owner[bent_ones])
    place = np.full(problem.values, -1)
    place[unknown] = np.arange(unknown.size)
    return Bent(unknown, place[problem.owner], bends, problem.along, problem.along_angle)


def sloped(problem: Problem, samples: Samples, *, every: bool = False) -> Bent:
    """Stiff values, with their whole slopes over all arguments, by differences.

    Args:
        problem: linear part and laws.
        samples: of the laws.
        every: all values that have slopes, stiff or not.
    """
    found = slopes(problem, samples.z)
    changing = np.flatnonzero(np.abs(found).max(axis=(0, 2)))
    unknown = changing if every else problem.stiff
    found = found[:, unknown]
    value, argument = np.nonzero(np.abs(found).max(axis=0))
    return Bent(
        unknown, value, found[:, value, argument], problem.arguments[argument],
        problem.of_angle[argument],
    )  # fmt: skip


def correct_at_once(
    problem: Problem,
    answer: Response,
    samples: Samples,
    off: np.ndarray,
    order: int,
    *,
    whole: bool = False,
) -> np.ndarray:
    """Changes of the values (values, harmonics).

    Args:
        problem: linear part and laws.
        answer: of the linear part, of all harmonics from 0 on.
        samples: of the laws.
        off: (values, harmonics) what the laws give and the motion lacks.
        order: highest harmonic that is solved for; others change by what is off.
        whole: take the slopes of the laws over all arguments, not their tangents: many times the
            cost, for laws whose tangents leave out too much.
    """
    found = sloped(problem, samples) if whole else bent(problem, samples)
    step = off.copy()
    if not found.unknown.size:
        return step
    matrix = jacobian(answer, found, order)
    wanted = packed(off[found.unknown, : order + 1])
    try:
        solved = np.linalg.solve(matrix, wanted)
    except np.linalg.LinAlgError:  # a law that does not bend where the search begins, as a limit
        solved = np.linalg.lstsq(matrix, wanted, rcond=None)[0]
    step[found.unknown, : order + 1] = unpacked(solved, order)
    return step


def jacobian(answer: Response, found: Bent, order: int) -> np.ndarray:
    """How what is lacking of unknowns, in real form, falls with them; see `fill_jacobian`."""
    gains = answer.gain(found.along, found.along_angle, found.unknown, order + 1)
    size = found.unknown.size * (2 * order + 1)
    matrix = np.empty((size, size))
    products = np.ascontiguousarray(in_frequency(found.bends.T, np.arange(2 * order + 1)))
    fill_jacobian(products, found.owner, gains, order, matrix)
    return matrix


def packed(values: np.ndarray) -> np.ndarray:
    """The real form of coefficients (unknowns, order + 1)."""
    return np.hstack([values.real, values[:, 1:].imag]).ravel()


def unpacked(real: np.ndarray, order: int) -> np.ndarray:
    """Coefficients (unknowns, order + 1) of a real form."""
    rows = real.reshape(-1, 2 * order + 1)
    found = rows[:, : order + 1].astype(complex)
    found[:, 1:] += 1j * rows[:, order + 1 :]
    return found


def slopes(problem: Problem, z: np.ndarray) -> np.ndarray:
    """(places, values, arguments): slopes of laws less mean tangents, by central differences.

    Args:
        problem: the laws.
        z: (places, arguments) of a whole period.
    """
    found = np.empty((len(z), problem.values, z.shape[1]))
    for a in range(z.shape[1]):
        step = max(_STEP * float(np.ptp(z[:, a])), _LEAST)
        sides = []
        for sign in (1.0, -1.0):
            moved = z.copy()
            moved[:, a] += sign * step
            sides.append(problem.laws(moved).f.copy())
        found[:, :, a] = (sides[0] - sides[1]) / (2.0 * step)
    return found - problem.tangent

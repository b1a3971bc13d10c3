"""What a motion lacks of what the laws give, and what a correction changes, as numbers."""

import math

import numpy as np

from herringbone.analysis.steady.harmonic_balance.fourier import squares
from herringbone.analysis.steady.harmonic_balance.problem import Problem, Samples


def rest_of(problem: Problem, samples: Samples) -> np.ndarray:
    """Laws' values less mean tangents (values, places)."""
    return (samples.f - samples.z @ problem.tangent.T).T


def residual_of(problem: Problem, samples: Samples, off: np.ndarray, counted: np.ndarray) -> float:
    """How far stiff values are off, over their sizes.

    Args:
        problem: linear part and laws.
        samples: what the laws give.
        off: (values, harmonics) that values differ by.
        counted: (harmonics,) true at those that count.
    """
    stiff = problem.stiff
    size = np.abs(samples.f[:, stiff]).max(axis=0, initial=0.0)
    if not size.all():  # contacts that are open all the time
        rest = samples.f[:, stiff] - samples.z @ problem.tangent[stiff].T
        size = np.where(size > 0.0, size, np.abs(rest).max(axis=0, initial=0.0))
    size += np.finfo(float).tiny
    return float(np.linalg.norm(off[stiff][:, counted] / size[:, None]))


def change_of(problem: Problem, before: np.ndarray, after: np.ndarray) -> float:
    """What a correction changes the stiff arguments by, over their alternating part.

    Over all of it where nothing alternates, as in equilibrium: it is no motion that has converged
    whatever it lacks.

    Args:
        problem: linear part and laws.
        before, after: arguments (arguments, harmonics).
    """
    rows = problem.directions @ after
    powers = squares(rows)
    sizes = powers[:, 1:].sum(axis=1)
    if not sizes.any():
        sizes = powers.sum(axis=1)
    moved = squares(rows - problem.directions @ before).sum(axis=1)
    sizes = np.where(sizes > 0.0, sizes, np.inf)
    return math.sqrt((moved / sizes).max(initial=0.0))

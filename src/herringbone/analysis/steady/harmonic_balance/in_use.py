"""Harmonics of a period of many meshes that are not negligible.

Values of the laws count by what they move the stiff arguments by, at the mesh frequency.
"""

import numpy as np

from herringbone.analysis.steady.harmonic_balance.fourier import in_frequency
from herringbone.analysis.steady.harmonic_balance.orbit import Period
from herringbone.analysis.steady.harmonic_balance.problem import Problem, Samples
from herringbone.analysis.steady.harmonic_balance.residual import rest_of
from herringbone.analysis.steady.harmonic_balance.response import Response


def in_use(
    problem: Problem, period: Period, answer: Response, values: np.ndarray, orders: np.ndarray
) -> np.ndarray:
    """Orders without which values lose a share of their alternation; see `Period.thin`.

    Args:
        problem: linear part and laws.
        period: how it is resolved.
        answer: of the linear part.
        values: (values, harmonics) of the laws.
        orders: (harmonics,) of these.
    """
    weights = _weights(problem, period, answer)
    energy = ((weights[:, None] * np.abs(values)) ** 2).sum(axis=0)
    energy[0] = 0.0
    ascending = np.argsort(energy)
    left_out = np.cumsum(energy[ascending]) <= period.thin**2 * energy.sum()
    used = np.ones(energy.size, dtype=bool)
    used[ascending[left_out]] = False
    used[0] = True
    return orders[used]


def share_outside(problem: Problem, period: Period, answer: Response, samples: Samples) -> float:
    """Share of the values' alternation that is at none of the lines of the period."""
    if not period.bases:
        return 0.0
    rest = rest_of(problem, samples)
    lines = in_frequency(rest, period.lines)[:, 1:]
    every = rest.var(axis=1)
    other = np.maximum(every - 2.0 * (np.abs(lines) ** 2).sum(axis=1), 0.0)
    weights = _weights(problem, period, answer) ** 2
    whole = float(weights @ every)
    return float(np.sqrt(weights @ other / whole)) if whole else 0.0


def _weights(problem: Problem, period: Period, answer: Response) -> np.ndarray:
    """(values,) what they move the stiff arguments by, at the mesh frequency."""
    mesh, every = answer.at(np.array([0, period.meshes])), np.arange(problem.values)
    gains = mesh.gain(problem.along, problem.along_angle, every, 2)[:, :, 1]
    return np.abs(problem.mean[:, None] * gains).sum(axis=0)

"""Matrices of one length of a step, for a ladder of lengths that are halved from rung to rung.

With the channels as polynomials over a step, through their values at Lobatto nodes, everything
linear is exact (M. Hochbruck and A. Ostermann, Exponential integrators, Acta Numerica 19, 2010,
section 2): phi functions of the eigenvalues.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from herringbone.analysis.twin.condensed.modes import Modes

LOBATTO = {
    2: (0.0, 0.5, 1.0),
    3: (0.0, 0.5 - math.sqrt(5.0) / 10.0, 0.5 + math.sqrt(5.0) / 10.0, 1.0),
    4: (0.0, 0.5 - math.sqrt(21.0) / 14.0, 0.5, 0.5 + math.sqrt(21.0) / 14.0, 1.0),
}
"""Nodes of a step by the degree of the polynomials through them."""
_SERIES = 18  # terms, for arguments up to 1


class Rungs(NamedTuple):
    """By rung; inputs: channels x nodes, rows: (nodes - 1) x arguments.

    Attributes:
        turn: (2, rungs, modes) factors of the coordinates, real and imaginary.
        rows: (2, rungs, modes, rows) arguments at the nodes of the coordinates at the start.
        of_inputs: (rungs, inputs, rows) arguments at the nodes of the inputs.
        push: (2, rungs, inputs, modes) coordinates at the end of the inputs.
        angle: (2, rungs, modes, rotations) angles' growth of the coordinates at the start.
        angle_of_inputs: (rungs, inputs, rotations).
        along: (rungs, nodes - 1, tangents, unknowns x (nodes - 1)), see `collocation`.
        lengths: (rungs,) [s].
    """

    turn: np.ndarray
    rows: np.ndarray
    of_inputs: np.ndarray
    push: np.ndarray
    angle: np.ndarray
    angle_of_inputs: np.ndarray
    along: np.ndarray
    lengths: np.ndarray


def powers(rates: np.ndarray, t: np.ndarray | float, degree: int) -> np.ndarray:
    """Integrals of exp(rate (t - s)) (s / t)^j from 0 to t, j = 0 ... degree.

    They are t g_j with g_j = sum of j! z^k / (k + j + 1)!, z = rate t, and j g_(j-1) = 1 + z g_j.

    Args:
        rates: (modes,) or (modes, 1) [1/s].
        t: times [s], which go together with the rates.
        degree: largest power.

    Returns:
        (degree + 1, *shape of rates x t).
    """
    z = rates * t
    small = np.abs(z) < 1.0
    near, far = np.where(small, z, 0.0), np.where(small, 1.0, z)
    term = np.full_like(near, 1.0 / (degree + 1))
    downward = term.copy()
    for k in range(_SERIES):
        term *= near / (k + degree + 2)
        downward += term
    upward = np.expm1(far) / far
    found = np.empty((degree + 1, *z.shape), dtype=complex)
    for j in range(degree + 1):
        if j > 0:
            upward = (j * upward - 1.0) / far
        found[j] = upward
    for j in range(degree, -1, -1):
        found[j] = np.where(small, downward, found[j])
        downward = (1.0 + near * downward) / max(j, 1)
    return t * found


def twice(once: np.ndarray, t: np.ndarray | float) -> np.ndarray:
    """What `powers` gives for j = 0 ... n, integrated once more from 0 to t: j = 0 ... n - 1."""
    return np.array([t * integral / (j + 1) for j, integral in enumerate(once[1:])])


def coefficients(degree: int) -> np.ndarray:
    """(degree + 1, degree + 1): powers of s / h of the polynomial through values at the nodes."""
    return np.linalg.inv(np.vander(np.array(LOBATTO[degree]), increasing=True))


class _Rung:
    """One rung."""

    def __init__(self, modes: Modes, h: float, degree: int) -> None:
        nodes, fit = LOBATTO[degree], coefficients(degree)
        channels, arguments = modes.inputs.shape[1], len(modes.arguments)
        rows, inputs = [], np.zeros((channels, degree + 1, degree, arguments))
        for i, c in enumerate(nodes[1:]):
            t, share = c * h, c ** np.arange(degree + 1)
            once = powers(modes.rates, t, degree + 1)
            growth = once[0]
            rows.append(modes.arguments * np.exp(modes.rates * t))
            rows[-1] += modes.of_angles @ (modes.turns * growth)
            of_nodes = fit.T @ (once[:-1] * share[:, None])
            turned = fit.T @ (twice(once, t) * share[:, None])
            driven = of_nodes[:, None] * modes.inputs.T
            angle = ((turned[:, None] * modes.inputs.T) @ modes.turns.T).real
            found = (driven @ modes.arguments.T).real
            inputs[:, :, i] = (found + angle @ modes.of_angles.T).transpose(1, 0, 2)
            inputs[:, i + 1, i] += modes.of_channels.T
        self.turn = np.exp(modes.rates * h)
        self.rows = np.concatenate(rows).T
        self.of_inputs = inputs.reshape(channels * (degree + 1), -1)
        self.push = driven.transpose(1, 0, 2).reshape(-1, modes.rates.size)
        self.angle = (modes.turns * growth).T
        self.angle_of_inputs = angle.transpose(1, 0, 2).reshape(-1, len(modes.turns))


def make_rungs(
    modes: Modes,
    lengths: Sequence[float],
    degree: int,
    directions: np.ndarray,
    stiff: Sequence[int],
) -> Rungs:
    """Matrices of steps of some lengths [s].

    Args:
        modes: of the system.
        lengths: by rung.
        degree: of the polynomials, see LOBATTO.
        directions: (tangents, arguments) of all laws.
        stiff: the laws' values that are unknowns.
    """
    made = [_Rung(modes, h, degree) for h in lengths]
    inputs = np.array([r.of_inputs for r in made])
    channels = modes.inputs.shape[1]
    shaped = inputs.reshape(len(made), channels, degree + 1, degree, directions.shape[1])
    along = np.einsum("ta,lsnia->litsn", directions, shaped[:, list(stiff), 1:])
    return Rungs(
        _parts([r.turn for r in made]),
        _parts([r.rows for r in made]),
        inputs,
        _parts([r.push for r in made]),
        _parts([r.angle for r in made]),
        np.array([r.angle_of_inputs for r in made]),
        np.ascontiguousarray(along.reshape(*along.shape[:3], len(stiff) * degree)),
        np.array(lengths, dtype=float),
    )


def _parts(values: list[np.ndarray]) -> np.ndarray:
    stacked = np.array(values)
    return np.ascontiguousarray(np.array([stacked.real, stacked.imag]))

"""Floquet multipliers of a periodic motion: what a small deviation is multiplied by in a period.

The equations, linearised on the motion, are a linear part that is advanced exactly and a few scalar
laws whose slopes repeat with the period,

    q' = L q + B s(t),    s = S(t) z,    z = Re(C q) + c theta,    theta' = Re(T q)

Over each step s is a polynomial through Lobatto nodes, as in the condensed core. The matrix that
takes all states through a period has the multipliers as eigenvalues (G. Floquet, Ann. Sci. Ecole
Norm. Sup. 12, 1883, 47-88). Beyond 1 the motion is unstable; where one passes 1 a branch folds,
where one passes -1 the period doubles.
"""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.harmonic_balance.correction import slopes
from herringbone.analysis.steady.harmonic_balance.orbit import Motion, Orbit
from herringbone.analysis.steady.harmonic_balance.problem import Problem
from herringbone.analysis.twin.condensed.rungs import LOBATTO, coefficients, powers, twice

_DEGREE = 3


class Multipliers(NamedTuple):
    """Of a periodic motion.

    Attributes:
        values: complex, the largest first; without those that are 1 because nothing changes when
            all begins later, turns at another speed where nothing holds it, or has another phase of
            a neutral mode.
        shifts: how many of these were left out.
    """

    values: np.ndarray
    shifts: int

    @property
    def largest(self) -> float:
        """Size of the largest one."""
        return float(np.abs(self.values).max(initial=0.0))


def multipliers(problem: Problem, motion: Motion, orbit: Orbit, steps: int) -> Multipliers:
    """Floquet multipliers of an orbit.

    Args:
        problem: linear part and laws.
        motion: what is given of it.
        orbit: the motion.
        steps: in the period.
    """
    found = np.linalg.eigvals(monodromy(problem, motion, orbit, steps))
    found = found[np.argsort(-np.abs(found))]
    shifts = bool(motion.turn) + (problem.free is not None) + len(problem.neutral)
    trivial = np.argsort(np.abs(found - 1.0))[:shifts]
    return Multipliers(np.delete(found, trivial), shifts)


def monodromy(problem: Problem, motion: Motion, orbit: Orbit, steps: int) -> np.ndarray:
    """What takes all states, as real coordinates, through a period; (n, n).

    Coordinates are the real parts of the modal ones, the imaginary parts of the oscillating ones,
    and theta, if anything turns.
    """
    h, rates, modes = orbit.period / steps, problem.rates, problem.rates.size
    oscillating = np.flatnonzero(rates.imag != 0.0)
    bends = _slopes(problem, motion, orbit, steps)
    active = np.flatnonzero(np.abs(bends).max(axis=(0, 1, 3)) > 0.0)
    bends = bends[:, :, active]
    inputs, nodes, fit = problem.inputs[:, active], LOBATTO[_DEGREE], coefficients(_DEGREE)
    count, arguments = active.size, len(problem.arguments)
    turning = 1 if motion.turn else 0
    q = np.hstack([
        np.eye(modes, dtype=complex), 1j * np.eye(modes)[:, oscillating],
        np.zeros((modes, turning), dtype=complex),
    ])  # fmt: skip
    angle = np.zeros(q.shape[1])
    angle[q.shape[1] - turning :] = 1.0
    grow, of_angle, pushes, turned = [], [], [], []
    for c in nodes:
        once = powers(rates, c * h, _DEGREE + 1) if c else np.zeros((_DEGREE + 2, modes))
        share = c ** np.arange(_DEGREE + 1)
        grow.append(np.exp(rates * c * h))
        of_angle.append(problem.turns * once[0])
        pushes.append((fit.T @ (once[:-1] * share[:, None]))[:, :, None] * inputs)
        doubled = fit.T @ (twice(once, c * h) * share[:, None])
        turned.append(((doubled * problem.turns) @ inputs).real)
    rows = [
        np.vstack([problem.arguments * g, a[None, :]]) for g, a in zip(grow, of_angle, strict=True)
    ]
    answers = np.array(
        [
            [
                (problem.arguments @ p).real + np.outer(problem.of_angle, t)
                for p, t in zip(pushes[i], turned[i], strict=True)
            ]
            for i in range(_DEGREE + 1)
        ]
    )  # fmt: skip (node, from node, arguments, active)
    size = (_DEGREE + 1) * count
    identity = np.eye(size)
    for step in range(steps):
        own = bends[step]
        free = np.empty((_DEGREE + 1, arguments, q.shape[1]))
        for i in range(_DEGREE + 1):
            both = (rows[i] @ q).real
            free[i] = both[:-1] + np.outer(problem.of_angle, both[-1] + angle)
        right = (own @ free).reshape(size, -1)
        mixed = np.einsum("iva,ijau->ivju", own, answers).reshape(size, size)
        s = np.linalg.solve(identity - mixed, right).reshape(_DEGREE + 1, count, -1)
        angle = angle + (of_angle[-1] @ q).real + np.einsum("ju,jun->n", turned[-1], s)
        q = grow[-1][:, None] * q + np.tensordot(pushes[-1], s, axes=((0, 2), (0, 1)))
    return np.vstack([q.real, q.imag[oscillating], angle[None, :]][: 2 + turning])


def _slopes(problem: Problem, motion: Motion, orbit: Orbit, steps: int) -> np.ndarray:
    """(steps, nodes, values, arguments): slopes of the laws less mean tangents."""
    found = []
    for c in LOBATTO[_DEGREE]:
        z = arguments_at(problem, motion, orbit, (np.arange(steps) + c) / steps)
        found.append(slopes(problem, z))
    return np.array(found).transpose(1, 0, 2, 3)


def arguments_at(problem: Problem, motion: Motion, orbit: Orbit, shares: np.ndarray) -> np.ndarray:
    """Arguments (places, arguments) of an orbit at shares of its period."""
    response = orbit.response
    z = response.of(problem.arguments, orbit.q) + problem.of_channels @ orbit.channels
    z += problem.of_angle[:, None] * orbit.angle
    z[:, 1:] *= 2.0
    turning = np.exp(2j * np.pi * np.outer(shares, response.orders))
    found = (turning @ z.T).real
    if motion.turn:
        turned = motion.angle + np.copysign(motion.turn, response.speed) * shares
        found += np.outer(turned, problem.of_angle)
    return np.ascontiguousarray(found)

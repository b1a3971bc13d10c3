"""Coordinates at times inside of steps, from what a march has kept of these."""

import numpy as np

from herringbone.analysis.twin.condensed.march_arrays import Samples
from herringbone.analysis.twin.condensed.modes import Modes
from herringbone.analysis.twin.condensed.rungs import coefficients, powers, twice
from herringbone.kernels.condensed.lines import padded

_GRID = 1e-9
"""Of a step: a time this close to its start is its start."""


def coordinates(samples: Samples, modes: Modes, degree: int) -> np.ndarray:
    """What `State.q` is at the times of samples, (times, 2 modes + rotations).

    Args:
        samples: of a march.
        modes: of the system.
        degree: of the polynomials in its steps.
    """
    m = modes.rates.size
    q = samples.held[:, : 2 * m + modes.angles.size].copy()
    inside = np.flatnonzero(samples.since > _GRID * samples.length)
    if inside.size:
        later, q[inside, 2 * m :] = _later(samples, inside, modes, degree)
        q[inside, :m], q[inside, m : 2 * m] = later.real, later.imag
    return q


def _later(
    samples: Samples, rows: np.ndarray, modes: Modes, degree: int
) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates and angles (times, ...) at times inside of steps."""
    m = modes.rates.size
    size = 2 * m + modes.angles.size
    held = samples.held[rows]
    q = (held[:, :m] + 1j * held[:, m : 2 * m]).T
    t, length = samples.since[rows], samples.length[rows]
    nodes = held[:, padded(size) :].reshape(rows.size, -1, degree + 1)
    driven = np.einsum("jn,tkn->jkt", coefficients(degree), nodes)
    of_powers = modes.inputs @ driven  # powers, modes, times
    of_powers *= ((t / length) ** np.arange(degree + 1)[:, None])[:, None]
    once = powers(modes.rates[:, None], t[None, :], degree + 1)
    growth = once[0] * q + (twice(once, t) * of_powers).sum(axis=0)
    angle = held[:, 2 * m : size] + (modes.turns @ growth).real.T
    now = np.exp(modes.rates[:, None] * t) * q + (once[:-1] * of_powers).sum(axis=0)
    return now.T, angle

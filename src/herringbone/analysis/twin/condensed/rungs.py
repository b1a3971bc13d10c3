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
from herringbone.kernels.condensed.lines import aligned, padded

_INNER = [math.sqrt((7.0 + s * 2.0 * math.sqrt(7.0)) / 21.0) for s in (1.0, -1.0)]
LOBATTO = {
    2: (0.0, 0.5, 1.0),
    3: (0.0, 0.5 - math.sqrt(5.0) / 10.0, 0.5 + math.sqrt(5.0) / 10.0, 1.0),
    4: (0.0, 0.5 - math.sqrt(21.0) / 14.0, 0.5, 0.5 + math.sqrt(21.0) / 14.0, 1.0),
    5: (0.0, *(0.5 - 0.5 * x for x in _INNER), *(0.5 + 0.5 * x for x in reversed(_INNER)), 1.0),
}
"""Nodes of a step by the degree of the polynomials through them."""
_SERIES = 18  # terms, for arguments up to 1


class Shape(NamedTuple):
    """What the matrices of a march are over.

    Attributes:
        degree: of the polynomials.
        lean: see `Fixed.lean`.
        directions: (tangents, arguments) of all laws.
        sharp: (n, arguments) directions of what is taken at all nodes, if lean.
        stiff: the laws' values that are unknowns.
        short: matrices that give arguments are in single precision, see `Rungs`.
    """

    degree: int
    lean: bool
    directions: np.ndarray
    sharp: np.ndarray
    stiff: tuple[int, ...]
    short: bool

    def rows(self, full: np.ndarray) -> np.ndarray:
        """What is wanted of arguments at all nodes, (..., nodes - 1, arguments)."""
        *over, nodes, arguments = full.shape
        if not self.lean:
            return full.reshape(*over, nodes * arguments)
        inner = (full[..., :-1, :] @ self.sharp.T).reshape(*over, (nodes - 1) * len(self.sharp))
        return np.concatenate([inner, full[..., -1, :]], axis=-1)


class Rungs(NamedTuple):
    """By rung; rows: (nodes - 1) x arguments, or see `Fixed.lean`; q: as of `State`.

    Both are padded with zeros where sums are formed over many of them at once.

    Of each channel, the first input stands for its value at the start, the last one for its rise
    along a straight line, and the others for what it is above that line at the other nodes.

    If they are `short`, rows over modes and of_inputs are in single precision, which waits for half
    of the memory. What it errs by (6e-8) shifts the laws' arguments, most of it once for all. But
    angles that grow would drift by it: rows over them stay in double precision, and their growth
    has two columns, the first for what the second one lacks. And means of outputs, thousands of
    times what alternates, follow from values at starts by `push`: what short_push lacks of it at a
    reference is added, see `refer`.

    Attributes:
        made: (rungs,) 1 where there are matrices, which are made when they are asked for.
        turn: (rungs, 2, modes) factors of the coordinates, real and imaginary.
        rows: (rungs, q, rows) what is wanted at the nodes, of the state at the start; the last ones
            are the growth of the angles, those before what it lacks.
        of_inputs: (rungs, inputs, rows) the same of the inputs.
        push: (rungs, inputs, q) state at the end of the inputs.
        along: (rungs, unknowns x (nodes - 1), (nodes - 1) x tangents), see `correction.correct`.
        lengths: (rungs,) [s].
        short_rows, short_of_inputs, short_push: the same in single precision; empty, or over the
            modes, whose rows are then not in `rows`, the inputs, for of_inputs, and beside `push`.
        still: (rungs, q) what short_push lacks.
    """

    made: np.ndarray
    turn: np.ndarray
    rows: np.ndarray
    of_inputs: np.ndarray
    push: np.ndarray
    along: np.ndarray
    lengths: np.ndarray
    short_rows: np.ndarray
    short_of_inputs: np.ndarray
    short_push: np.ndarray
    still: np.ndarray


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


def midway(degree: int) -> np.ndarray:
    """(nodes - 1, nodes): values between two nodes each, of the polynomial through all nodes."""
    nodes = np.array(LOBATTO[degree])
    middles = 0.5 * (nodes[1:] + nodes[:-1])
    found: np.ndarray = np.vander(middles, degree + 1, increasing=True) @ coefficients(degree)
    return found


def continued(degree: int, of: int, share: float) -> np.ndarray:
    """(nodes, nodes): values of a step, continued over the next one, whose length is a share of it.

    Along the polynomial of the degree `of` that goes through the end and fits the others best.
    """
    nodes = np.array(LOBATTO[degree])
    since_end = np.vander(nodes - 1.0, of + 1, increasing=True)[:, 1:]
    from_end = np.eye(degree + 1)
    from_end[:, -1] -= 1.0
    on = np.vander(share * nodes, of + 1, increasing=True)[:, 1:]
    found: np.ndarray = on @ (np.linalg.pinv(since_end) @ from_end)
    found[:, -1] += 1.0
    return found.T


def parts(values: np.ndarray) -> np.ndarray:
    """Rows (2 modes, ...) over real and imaginary parts, of complex rows (modes, ...)."""
    return np.concatenate([values.real, -values.imag])


def _of_inputs(matrix: np.ndarray, nodes: Sequence[float]) -> np.ndarray:
    """Matrix over inputs, from one over values (channels, nodes, n)."""
    found = matrix.copy()
    found[:, 0] = matrix.sum(axis=1)
    found[:, -1] = np.einsum("i,cin->cn", nodes, matrix)
    return found.reshape(matrix.shape[0] * matrix.shape[1], matrix.shape[2])


def empty_rungs(modes: Modes, lengths: Sequence[float], shape: Shape) -> Rungs:
    """Room for matrices of steps of some lengths [s]; see `make_rung`."""
    m, k, degree = modes.rates.size, len(modes.turns), shape.degree
    rungs, q = len(lengths), padded(2 * m + k)
    inputs = modes.inputs.shape[1] * (degree + 1)
    rows = padded(shape.rows(np.zeros((degree, len(modes.arguments)))).size + 2 * k)
    unknowns = len(shape.stiff) * degree
    of_long, of_short = (0, rungs) if shape.short else (rungs, 0)
    modal = 2 * m if shape.short else 0
    return Rungs(
        np.zeros(rungs, dtype=np.int64),
        np.zeros((rungs, 2, m)),
        aligned(rungs, 2 * m + k - modal, rows),
        aligned(of_long, inputs, rows),
        aligned(rungs, inputs, q),
        aligned(rungs, unknowns, degree * len(shape.directions)),
        np.array(lengths, dtype=float),
        aligned(of_short, modal, rows, dtype=np.float32),
        aligned(of_short, inputs, rows, dtype=np.float32),
        aligned(of_short, inputs, q, dtype=np.float32),
        aligned(of_short, q),
    )


def make_rung(rungs: Rungs, rung: int, modes: Modes, shape: Shape) -> None:
    """Fill in the matrices of one rung.

    Args:
        rungs: as `empty_rungs` gives them.
        rung: that is wanted.
        modes: of the system.
        shape: of the march.
    """
    h, m, degree = float(rungs.lengths[rung]), modes.rates.size, shape.degree
    nodes, fit = LOBATTO[degree], coefficients(degree)
    channels, arguments = modes.inputs.shape[1], len(modes.arguments)
    rows, inputs = [], np.zeros((channels, degree + 1, degree, arguments))
    for i, c in enumerate(nodes[1:]):
        t, share = c * h, c ** np.arange(degree + 1)
        once = powers(modes.rates, t, degree + 1)
        growth = once[0]
        rows.append((modes.arguments * np.exp(modes.rates * t)).T)
        rows[-1] += (modes.of_angles @ (modes.turns * growth)).T
        of_nodes = fit.T @ (once[:-1] * share[:, None])
        turned = fit.T @ (twice(once, t) * share[:, None])
        driven = of_nodes[:, None] * modes.inputs.T
        angle = ((turned[:, None] * modes.inputs.T) @ modes.turns.T).real
        found = (driven @ modes.arguments.T).real
        inputs[:, :, i] = (found + angle @ modes.of_angles.T).transpose(1, 0, 2)
        inputs[:, i + 1, i] += modes.of_channels.T
    ends = np.concatenate([driven.real, driven.imag, angle], axis=2).transpose(1, 0, 2)
    rungs.turn[rung] = np.exp(modes.rates * h).real, np.exp(modes.rates * h).imag
    at_nodes = shape.rows(parts(np.stack(rows, axis=1)))
    count, size = at_nodes.shape[1], ends.shape[2]
    of_modes = (rungs.short_rows if shape.short else rungs.rows)[rung, : 2 * m]
    of_modes[:, :count] = at_nodes
    turns, width = len(modes.turns), of_modes.shape[1]
    of_angles = np.broadcast_to(modes.of_angles.T[:, None], (turns, degree, arguments))
    rungs.rows[rung, rungs.rows.shape[1] - turns :, :count] = shape.rows(of_angles)
    of_inputs = rungs.short_of_inputs if shape.short else rungs.of_inputs
    of_inputs[rung, :, :count] = _of_inputs(shape.rows(inputs), nodes)
    angles = parts((modes.turns * growth).T)
    of_modes[:, width - turns :] = angles
    of_modes[:, width - 2 * turns : width - turns] = angles - of_modes[:, width - turns :]
    rungs.push[rung, :, :size] = _of_inputs(ends, nodes)
    rungs.short_push[rung : rung + 1] = rungs.push[rung]
    along = inputs[list(shape.stiff), 1:] @ shape.directions.T
    rungs.along[rung] = along.reshape(rungs.along.shape[1:])
    rungs.made[rung] = 1


def refer(rungs: Rungs, rung: int, reference: np.ndarray) -> None:
    """Let single precision be exact where all channels keep a value, (channels,)."""
    if len(rungs.short_push):
        starts = slice(None, None, rungs.push.shape[1] // reference.size)
        off = rungs.push[rung, starts] - rungs.short_push[rung, starts]
        rungs.still[rung] = reference @ off

"""The fastest growing motion of one macro step, from the eigenvalues of its matrix."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import lu_factor, lu_solve
from scipy.linalg.lapack import dgebal

from herringbone.core.process.one_thread import one_blas_thread

GROWTH = 1e-6
"""Growth per macro step above which a step is called unstable: invisible in 1e5 steps."""
RIGID = 1e-5
"""Eigenvalues this close to 1 are the free rotation of the shafts (a double one is known to the
square root of rounding only) and motions that take more than 1e5 steps; they are left out."""
_SPLIT, _EVENLY = 9e-4, 0.05
"""Errors of what stands for foreign parts split a double eigenvalue evenly, by so much at most: its
mean stays where it was, while what the coupling adds moves both, or one of them. The first is set,
not measured: double eigenvalues go by the root of an error, and this is the root of 8e-7, eighty
times the error that is stated of such matrices.
"""
_HALFWAY = 0.5
NEAR_MIRROR = 1.1
"""Steps longer by so much at most bring a motion of `Growth.near_mirror` to half the rate."""
_SLOW = 0.3
"""Eigenvalues this close to 1 belong to motions that a macro step resolves well."""
_SAMPLES, _MARGIN = 2, 3.0
_ASIDE, _ROUNDS = 1e-9, 3
"""Share by which a known eigenvalue is missed, so that a matrix can be solved; rounds of that."""
_EXACT = 1e-8
"""A double eigenvalue that errors of 1e-16 and more have split is further from 1."""
_TURN = 1e-7
"""So close to 1 is the turn of everything in a matrix of differences, which errs by 1e-8."""


@dataclass(frozen=True)
class Growth:
    """The fastest growing motion of a coupled system.

    Attributes:
        radius: largest magnitude of an eigenvalue, rigid rotation left out.
        frequency: of that motion [Hz], at most half the rate of communication points.
        fast_radius: the same of motions that are not slow against the step. Slow ones decay by
            next to nothing in a step at any step; these tell when an unstable band is near.
        mirror_radius: the same of motions at half the rate of communication points: there a motion
            meets its own mirror image, and one of the two grows at the expense of the other.
        fast_change: of the motion of `fast_radius` in a step, distance of its eigenvalue from 1.
        near_mirror: the same as `radius` of motions that come to half the rate of communication
            points in a step that is longer by a tenth or less; infinite: not known.
        own: growth in time of a slow motion [1/s] that is there whatever the step; 0: none known.
    """

    radius: float
    frequency: float
    fast_radius: float
    mirror_radius: float = 0.0
    fast_change: float = np.inf
    near_mirror: float = np.inf
    own: float = 0.0

    def per_step(self, steps: int) -> "Growth":
        """The same for one macro step, of the growth in so many."""
        root = 1.0 / steps
        return replace(
            self,
            radius=self.radius**root,
            fast_radius=self.fast_radius**root,
            mirror_radius=self.mirror_radius**root,
            near_mirror=np.inf,
        )

    def was_slow(self, share: float) -> bool:
        """True if the motion of `fast_radius` is a slow one in this share of the step."""
        return share * self.fast_change < _SLOW


def growth_of(matrix: np.ndarray, step: float, noise: float = 0.0, rigid: float = RIGID) -> Growth:
    """The fastest growing motion of one macro step [s], from the eigenvalues of its matrix.

    Args:
        matrix: of the step.
        step: its length [s].
        noise: error of the matrix over its size; eigenvalues that it may have moved from 1 are left
            out like 1 itself.
        rigid: eigenvalues this close to 1 are left out.
    """
    if matrix.size == 0:
        return Growth(0.0, 0.0, 0.0)
    with one_blas_thread():
        eigenvalues = np.linalg.eigvals(matrix)
        found = _fastest(eigenvalues[~_free(eigenvalues, noise, rigid)], step)
        # Errors can only make it less; and they bring nothing here from 1 that is so far away.
        if noise == 0.0 or found.radius <= 1.0 + GROWTH or _is_far(found, step):
            return found
        if _is_sure(matrix, _eigenvalue(found, step), noise):
            return found
        eigenvalues, known = _with_errors(matrix, noise)
    moving = (np.abs(eigenvalues - 1.0) > known) & ~_free(eigenvalues, noise, rigid)
    return _fastest(eigenvalues[moving], step)


def pair_growth(matrix: np.ndarray, found: Growth | None, step: float) -> float | None:
    """Growth per macro step that the free rotation's two motions have in the mean.

    Errors of a model split the two by an amount that differs at any two steps, and leave the mean.

    Args:
        matrix: of a step [s].
        found: a motion of this matrix that must be one of the two; None: any.
        step: length of the step [s].

    Returns:
        None if the two are further apart than errors bring them, or do not hold what was found.
    """
    with one_blas_thread():
        off = np.linalg.eigvals(matrix) - 1.0
    off = off[np.abs(off) > _EXACT]
    nearest = off[np.argsort(np.abs(off))]
    pair, others = nearest[:2], np.abs(nearest[2:])
    if len(pair) < 2 or np.abs(pair).max() > _SPLIT:
        return None
    # Where rounding splits the two otherwise, what was found is neither of these to the digit.
    reach = _HALFWAY * others.min(initial=np.inf)
    if found is not None and abs(_eigenvalue(found, step) - 1.0) > reach:
        return None
    return float(pair.mean().real)


def _free(eigenvalues: np.ndarray, noise: float, rigid: float) -> np.ndarray:
    """(n,) True for the free rotation of the shafts, and for what is so close to 1."""
    off = eigenvalues - 1.0
    found = np.abs(off) <= rigid
    pair = np.argsort(np.abs(off))[:2]
    largest = np.abs(off[pair]).max(initial=0.0)
    if noise and len(pair) == 2 and largest < _SPLIT and abs(off[pair].mean()) < _EVENLY * largest:
        found[pair] = True
    return found


def _eigenvalue(found: Growth, step: float) -> complex:
    """That of the fastest motion, of the two the one that turns forward."""
    return complex(found.radius * np.exp(2j * np.pi * found.frequency * step))


def _is_far(found: Growth, step: float) -> bool:
    """True if the fastest motion's eigenvalue is not close to 1."""
    return abs(_eigenvalue(found, step) - 1.0) > _SLOW


def _is_sure(matrix: np.ndarray, value: complex, noise: float) -> bool:
    """True if an eigenvalue's condition alone tells that errors do not move it from 1.

    With right and left vectors v, w of length 1 an error of size e moves it by e / |w v| at most,
    to first order; a margin is left for what is of higher order. Double ones have w v = 0.
    """
    scaled = dgebal(matrix, scale=1)[0]
    shifted = scaled - value * (1.0 + _ASIDE) * np.eye(len(scaled))
    factors = lu_factor(shifted, check_finite=False)
    right = left = np.random.default_rng(0).standard_normal(len(scaled)).astype(complex)
    for _ in range(_ROUNDS):
        right = lu_solve(factors, right, check_finite=False)
        left = lu_solve(factors, left, trans=2, check_finite=False)
        right, left = right / np.linalg.norm(right), left / np.linalg.norm(left)
    missed = np.linalg.norm(scaled @ right - value * right)
    error = max(noise * float(np.linalg.norm(scaled)), float(missed))
    return bool(_MARGIN * error < abs(np.vdot(left, right)) * abs(value - 1.0) / _MARGIN)


def _fastest(eigenvalues: np.ndarray, step: float) -> Growth:
    sizes = np.abs(eigenvalues)
    if sizes.size == 0:
        return Growth(0.0, 0.0, 0.0)
    angles = np.abs(np.angle(eigenvalues))
    largest = int(np.argmax(sizes))
    frequency = float(angles[largest] / (2.0 * np.pi * step))
    changes = np.abs(eigenvalues - 1.0)
    fast = int(np.argmax(np.where(changes > _SLOW, sizes, 0.0)))
    is_fast = bool(changes[fast] > _SLOW)
    mirror = float(sizes[angles == np.pi].max(initial=0.0))
    return Growth(
        float(sizes[largest]),
        frequency,
        float(sizes[fast]) if is_fast else 0.0,
        mirror,
        float(changes[fast]) if is_fast else np.inf,
        float(sizes[angles >= np.pi / NEAR_MIRROR].max(initial=0.0)),
    )


def _with_errors(matrix: np.ndarray, noise: float) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues, and how far errors of the matrix move each: as far as random ones of the size.

    Double eigenvalues go by the square root of an error, which no condition number tells. A turn of
    everything that the matrix leaves as it is, is left so by its errors, too.
    """
    scaled = dgebal(matrix, scale=1)[0]
    values, vectors = np.linalg.eig(scaled)
    rigid = np.linalg.qr(vectors[:, np.abs(values - 1.0) < _TURN].real)[0]
    random = np.random.default_rng(0)
    moved = np.zeros(len(values))
    size = noise * np.linalg.norm(scaled, 2) / np.sqrt(len(values))
    for _ in range(_SAMPLES):
        error = size * random.standard_normal(scaled.shape)
        other = np.linalg.eigvals(scaled + error - error @ rigid @ rigid.T)
        moved = np.maximum(moved, np.abs(values[:, None] - other).min(axis=1))
    return values, _MARGIN * moved

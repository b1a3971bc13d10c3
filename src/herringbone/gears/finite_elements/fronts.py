"""Parts of a stack of layers: joined, and what is inside of them eliminated."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.linalg import cholesky, solve_triangular

_ROWS = 256
"""Of a matrix, that are worked on at a time."""
_LARGE = 100_000
"""Numbers from which on memory is kept for another matrix."""
_KEPT = 3
"""Matrices, at most, whose memory is free."""
_WASTE = 2
"""Times what is needed, at most, that a matrix takes."""


class Part(NamedTuple):
    """A part of the stack, its inside eliminated.

    Attributes:
        unknowns: that are left, ascending, shape (b,); numbered from its first section.
        stiffness: among them, shape (b, b) [N/m].
        loads, measures: on them, of the sections that it touches, shapes (b, sections, q), (.., r).
        compliance: what its inside adds, shape (sections, r, sections, q) [m/N].
    """

    unknowns: np.ndarray
    stiffness: np.ndarray
    loads: np.ndarray
    measures: np.ndarray
    compliance: np.ndarray


class Memory:
    """Matrices in memory that is used again: new memory takes longer than what is done in it."""

    def __init__(self) -> None:
        self._free: list[np.ndarray] = []

    def zeros(self, size: int) -> np.ndarray:
        """Square matrix."""
        count = size * size
        if count < _LARGE:
            return np.zeros((size, size))
        fits = [i for i, f in enumerate(self._free) if count <= len(f) <= _WASTE * count]
        flat = self._free.pop(fits[0]) if fits else np.empty(count)
        flat[:count] = 0.0
        return flat[:count].reshape(size, size)

    def give_back(self, part: Part) -> None:
        """Take the memory of a part that is needed no more."""
        flat = part.stiffness.base
        if flat is not None and flat.ndim == 1 and len(flat) >= _LARGE:
            self._free = [flat, *self._free][:_KEPT]


def eliminated(
    parts: Sequence[Part],
    first_sections: Sequence[int],
    rows: Sequence[np.ndarray],
    inside: int,
    left: np.ndarray,
    memory: Memory,
) -> Part:
    """Parts as one, without its first unknowns.

    Args:
        parts: which are joined.
        first_sections: of the whole, at which they begin.
        rows: of the whole, that their unknowns are.
        inside: number of the first unknowns.
        left: the other ones.
        memory: where the matrix is made.
    """
    size = inside + left.size
    sections = max(k + len(p.compliance) for p, k in zip(parts, first_sections, strict=True))
    q = max(part.loads.shape[2] for part in parts)
    r = max(part.measures.shape[2] for part in parts)
    stiffness = memory.zeros(size)
    loads, measures = np.zeros((size, sections, q)), np.zeros((size, sections, r))
    compliance = np.zeros((sections, r, sections, q))
    for part, first, own in zip(parts, first_sections, rows, strict=True):
        stiffness[own[:, None], own] += part.stiffness
        if part.loads.shape[2]:
            here = slice(first, first + len(part.compliance))
            loads[own, here] += part.loads
            measures[own, here] += part.measures
            compliance[here, :, here] += part.compliance
    if inside:
        factor = cholesky(stiffness[:inside, :inside], lower=True, check_finite=False)
        link = _solved(factor, stiffness[:inside, inside:])
        stiffness = stiffness[inside:, inside:]
        _subtract_square(stiffness, link)
        if q:
            pushed, seen = (_solved(factor, v[:inside]) for v in (loads, measures))
            compliance += np.tensordot(seen, pushed, (0, 0))
            loads = loads[inside:] - np.tensordot(link, pushed, (0, 0))
            measures = measures[inside:] - np.tensordot(link, seen, (0, 0))
        else:
            loads, measures = loads[inside:], measures[inside:]
    return Part(left, stiffness, loads, measures, compliance)


def _subtract_square(matrix: np.ndarray, factor: np.ndarray) -> None:
    """Subtract factor^T factor from a symmetric matrix, by rows: new memory takes longer."""
    for first in range(0, len(matrix), _ROWS):
        rows, after = slice(first, first + _ROWS), slice(first + _ROWS, None)
        matrix[rows, first:] -= factor[:, rows].T @ factor[:, first:]
        matrix[after, rows] = matrix[rows, after].T


def _solved(factor: np.ndarray, right: np.ndarray) -> np.ndarray:
    found = solve_triangular(factor, right.reshape(len(right), -1), lower=True, check_finite=False)
    return found.reshape(right.shape)

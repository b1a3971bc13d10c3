"""The error of an inner step of Runge-Kutta, by the sizes of the states, and the step after it.

The estimate of a state counts by the largest one of its kind, those of the same unit and usual
size, or by that size if it is larger: a velocity that passes zero needs no better. An angle that
grows counts by its usual size alone, and a state vector by its largest element.
"""

import math
from collections.abc import Callable
from typing import NamedTuple, Self

import numpy as np

from herringbone.core.declaring.declaration import Declaration
from herringbone.core.declaring.variable import Variable
from herringbone.kernels.compiling.jit import inner, kernel

_WEIGHT = 0.1
_SAFETY, _LESS, _MORE = 0.9, 0.2, 2.0
_FLOOR = 1e-12
"""Usual size of vectors that are at rest, in their units."""


class Slots(NamedTuple):
    """Places in the work space of a step, behind the rates.

    Attributes:
        x0: states at its start.
        slope: sum of the rates.
        first, last: rates at its start and end.
        size_of, error_of_kind: by kind of states.
        known: not 0 where the rates at the start are.
    """

    x0: int
    slope: int
    first: int
    last: int
    size_of: int
    error_of_kind: int
    known: int

    @classmethod
    def of(cls, n: int) -> Self:
        """Of a body with n states."""
        return cls(*(k * n for k in range(1, 8)))


@kernel
def worse(a: float, b: float) -> float:
    """The larger one; NaN if one of them is."""
    if a >= b:
        return a
    return b if b > a else a + b


@kernel
def factor(error: float) -> float:
    """By what a step is to be multiplied whose error is so many times the tolerance."""
    if not error < np.inf:
        return _LESS
    if error < 1e-6:
        return _MORE
    return max(_LESS, min(_MORE, _SAFETY / math.sqrt(math.sqrt(error))))


def _kind(v: Variable) -> tuple[str, float, bool]:
    """What the error of a state is measured by; the last one: by its usual size alone."""
    return v.unit, v.nominal, v.steady == "rotating"


def error_measure(declaration: Declaration, slots: Slots) -> Callable:
    """Compile error_of(b, w, hs) -> float: of a step of that length [s], by the states' sizes."""
    visible = len(declaration.states)
    kinds = list(dict.fromkeys(_kind(v) for v in declaration.states))
    kind_of = tuple(kinds.index(_kind(v)) for v in declaration.states)
    sizes, kind_count = tuple(size for _, size, _ in kinds), len(kinds)
    grows = tuple(float(v.steady != "rotating") for v in declaration.states)
    ends, at_vector = [], visible
    for vector in declaration.vectors:
        at_vector += vector.capacity
        ends.append(at_vector)
    vector_count, vectors = len(ends), np.array(ends, dtype=np.int64)
    last, size_of, error_of_kind = slots.last, slots.size_of, slots.error_of_kind

    @inner(declaration.name)
    def error_of(b: np.ndarray, w: np.ndarray, hs: float) -> float:
        worst = 0.0
        for kind in range(kind_count):
            w[size_of + kind], w[error_of_kind + kind] = sizes[kind], 0.0
        for i in range(visible):
            of = kind_of[i]
            w[size_of + of] = max(w[size_of + of], grows[i] * abs(b[i]))
            w[error_of_kind + of] = worse(w[error_of_kind + of], abs(w[last + i] - w[i]))
        for kind in range(kind_count):
            worst = worse(worst, w[error_of_kind + kind] / w[size_of + kind])
        begin = visible
        for v in range(vector_count):
            size, error = _FLOOR, 0.0
            for i in range(begin, vectors[v]):
                size = max(size, abs(b[i]))
                error = worse(error, abs(w[last + i] - w[i]))
            begin = vectors[v]
            worst = worse(worst, error / size)
        return _WEIGHT * hs * worst

    return error_of

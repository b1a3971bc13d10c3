"""The error of an inner step of Runge-Kutta, by the sizes of the states, and the step after it.

The estimate of a state counts by the largest one of its kind, those of the same unit and usual
size, or by that size if it is larger: a velocity that passes zero needs no better. An angle that
grows counts by its usual size alone, and a state vector by its largest element.

Where rates are forces at positions, the embedded formula sees little of how they run over a step: a
position that is wrong by some power of the step changes them by two powers more. At the knots of a
law's table, where its curvature jumps, a step errs unseen. So the rates' second differences are
compared with those of the step before: of a jump J at a share c of the step they show 2 (1 - c)^2 J
from c = 1/2 on, and Simpson's rule, which Runge-Kutta is then, errs (1 - c)^2 (1 - 2 c) J h^3 / 12,
at most J h^3 / 324 (c = 2/3). By that ratio, 1/72, they count; earlier in the step they show more,
later at least a third of the error. Of smooth rates it is 1.7 times the embedded estimate, both of
third order. A step that has none before counts by the whole of them, see `explicit`.
"""

import math
from collections.abc import Callable
from typing import NamedTuple, Self

import numpy as np

from herringbone.core.declaring.declaration import Declaration
from herringbone.core.declaring.variable import Variable
from herringbone.kernels.compiling.jit import inner, kernel

_WEIGHT = 0.1
_OF_JUMP = 1.0 / 72.0
"""Error of a step over its length and the difference of its curvature from the last one's."""
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
        bend: second differences of the rates over the last step.
        start: states where steps begin that have none before.
        length: of the last step; 0 if there is none.
        known: not 0 where the rates at the start are.
    """

    x0: int
    slope: int
    first: int
    last: int
    size_of: int
    error_of_kind: int
    bend: int
    start: int
    length: int
    known: int

    @classmethod
    def of(cls, n: int) -> Self:
        """Of a body with n states."""
        return cls._make([*(k * n for k in range(1, 10)), 9 * n + 1])


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


def error_measure(declaration: Declaration, slots: Slots) -> tuple[Callable, Callable]:
    """Compile error_of(b, w, hs, jumps) -> float and go_on(w, hs, follows), of a step of hs [s].

    The error is by the states' sizes, with what jumps of curvature do, or without. `go_on` makes
    the rates at the end of a step those at the start of the next one, and keeps their second
    differences for its error, if that follows.
    """
    n, visible = declaration.state_count, len(declaration.states)
    kinds = list(dict.fromkeys(_kind(v) for v in declaration.states))
    kind_of = tuple(kinds.index(_kind(v)) for v in declaration.states)
    sizes, kind_count = tuple(size for _, size, _ in kinds), len(kinds)
    grows = tuple(float(v.steady != "rotating") for v in declaration.states)
    ends, at_vector = [], visible
    for vector in declaration.vectors:
        at_vector += vector.capacity
        ends.append(at_vector)
    vector_count, vectors = len(ends), np.array(ends, dtype=np.int64)
    slope, first, last, size_of, error_of_kind, bend = slots[1:7]
    length = slots.length

    @inner(declaration.name)
    def bend_of(w: np.ndarray, i: int) -> float:
        """Second difference of a rate over the step, with its mean in the middle."""
        return w[i] - 0.5 * w[slope + i] + 1.5 * w[first + i]

    @inner(declaration.name)
    def missed(w: np.ndarray, i: int, share: float, jumps: bool) -> float:
        """What a rate was wrong by, over the weight of the embedded formula."""
        found = abs(w[last + i] - w[i])
        if jumps:
            jump = 4.0 * (bend_of(w, i) - share * w[bend + i])
            found = worse(found, _OF_JUMP / _WEIGHT * abs(jump))
        return found

    @inner(declaration.name)
    def error_of(b: np.ndarray, w: np.ndarray, hs: float, jumps: bool) -> float:
        worst, share = 0.0, 0.0
        if w[length] > 0.0:
            share = (hs / w[length]) ** 2
        for kind in range(kind_count):
            w[size_of + kind], w[error_of_kind + kind] = sizes[kind], 0.0
        for i in range(visible):
            of = kind_of[i]
            w[size_of + of] = max(w[size_of + of], grows[i] * abs(b[i]))
            w[error_of_kind + of] = worse(w[error_of_kind + of], missed(w, i, share, jumps))
        for kind in range(kind_count):
            worst = worse(worst, w[error_of_kind + kind] / w[size_of + kind])
        begin = visible
        for v in range(vector_count):
            size, error = _FLOOR, 0.0
            for i in range(begin, vectors[v]):
                size = max(size, abs(b[i]))
                error = worse(error, missed(w, i, share, jumps))
            begin = vectors[v]
            worst = worse(worst, error / size)
        return _WEIGHT * hs * worst

    @inner(declaration.name)
    def go_on(w: np.ndarray, hs: float, follows: bool) -> None:
        w[length] = hs
        if follows:
            for i in range(n):
                w[bend + i] = bend_of(w, i)
        for i in range(n):
            w[first + i] = w[i]

    return error_of, go_on

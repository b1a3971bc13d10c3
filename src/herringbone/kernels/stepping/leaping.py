"""What a step that follows a tolerance asks of a component that can leap ahead of Runge-Kutta."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from herringbone.kernels.compiling.jit import inner, kernel

AT_ONCE, LATER, ANEW = 0, 1, 2
"""How outputs are made: as they follow from the step, the same when they are asked for, or from the
inputs of now."""
SAME = 1e-9
"""Relative difference of lengths that are one: rounding of times."""


class Leaps(NamedTuple):
    """Kernels of a component.

    Attributes:
        leap: (b, w, t, h, begin, end, tolerance, degree) -> float: from t + begin towards t + end
            inside of a macro step of length h [s], if it is ready; time since t that it has
            reached.
        ready: (b, w, t) -> bool: prepares leaps, once; True if there can be some.
        bent: (b, w, t, row) -> bool: writes indicators of the laws to a row, 0 or 1, after the
            rates; True if one's sign differs in the other row.
        forget: (b, w): the states are to be others than it left.
        show: (b, w, t, how) -> bool: writes states and outputs at the end of a step; False if they
            are made but when they are asked for.
    """

    leap: Callable
    ready: Callable
    bent: Callable
    forget: Callable
    show: Callable


def no_leaps(out: Callable, owner: str) -> Leaps:
    """Those of a component that takes none; `out` writes its outputs."""

    @inner(owner)
    def show(b: np.ndarray, w: np.ndarray, t: float, how: int) -> bool:
        out(b, t)
        return True

    return Leaps(_stay, _idle, _straight, _nothing, show)


@kernel
def _stay(
    b: np.ndarray, w: np.ndarray, t: float, h: float, begin: float, end: float,
    tolerance: float, degree: int,
) -> float:  # fmt: skip
    return begin


@kernel
def _idle(b: np.ndarray, w: np.ndarray, t: float) -> bool:
    return False


@kernel
def _straight(b: np.ndarray, w: np.ndarray, t: float, row: int) -> bool:
    return False


@kernel
def _nothing(b: np.ndarray, w: np.ndarray) -> None:
    """Nothing is to be done when states are changed."""

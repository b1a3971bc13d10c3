"""Slopes of functions of all states, by forward differences."""

from collections.abc import Callable, Sequence

import numpy as np

_DIFFERENCE = 1e-3
"""Of a state, over its size."""


def slopes(
    function: Callable[[np.ndarray], np.ndarray],
    x: np.ndarray,
    value: np.ndarray,
    scale: np.ndarray,
    states: Sequence[int] | np.ndarray,
) -> np.ndarray:
    """(m, k) slopes of m values of a function to some states over their sizes.

    Args:
        function: of all states (n,).
        x: states (n,) at which they are asked for.
        value: (m,) of the function there.
        scale: sizes of all states (n,).
        states: (k,) indices of those that are moved.
    """
    columns = []
    for i in states:
        moved = x.copy()
        moved[i] += _DIFFERENCE * scale[i]
        columns.append((function(moved) - value) / _DIFFERENCE)
    return np.array(columns).T

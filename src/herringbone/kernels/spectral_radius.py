"""Largest eigenvalue of a body's linearised equations, by power iteration.

The Jacobian acts by differences, on directions in which no state moves by more than a small part
of its usual size. Eigenvalues come in conjugate pairs, under which a direction turns from positions
to velocities and back: growth is counted over two applications at a time.
"""

import math
from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import inner
from herringbone.kernels.steppers import Rhs
from herringbone.kernels.stepping.local_error import worse

_PART = 1e-3
"""Displacement of a state over its usual size."""
_WARM, _ROOTS = 24, 4
_COUNTED = 2**_ROOTS
"""Applications until the direction counts as found, and those whose growth is averaged."""


def radius_scratch(states: int) -> int:
    """Length of the scratch space for so many states."""
    return 4 * states


def spectral_radius(
    rhs: Rhs, usual: tuple[float, ...], scratch: int, owner: str
) -> Callable[[np.ndarray, float], float]:
    """Compile the search for the largest absolute value of an eigenvalue.

    Args:
        rhs: kernel.
        usual: sizes of the states, which come first in the block.
        scratch: index in the block of `radius_scratch` numbers.
        owner: name of the component, for messages.

    Returns:
        radius(b, t) -> float: [1/s], in the state of the block; 0 or not finite where nothing
        moves or the equations cannot be evaluated.
    """
    n, sizes = len(usual), tuple(_PART * size for size in usual)
    count = _WARM + _COUNTED
    end = scratch + radius_scratch(n)

    @inner(owner)
    def radius(b: np.ndarray, t: float) -> float:
        kept, here = b[scratch : scratch + n], b[scratch + n : scratch + 2 * n]
        there, u = b[scratch + 2 * n : scratch + 3 * n], b[scratch + 3 * n : end]
        rhs(b, t, here)
        for i in range(n):
            kept[i] = b[i]
            u[i] = sizes[i]
        growth, largest = 1.0, 0.0
        for k in range(count):
            for i in range(n):
                b[i] = kept[i] + u[i]
            rhs(b, t, there)
            largest = 0.0
            for i in range(n):
                u[i] = there[i] - here[i]
                largest = worse(largest, abs(u[i]) / sizes[i])
            if not 0.0 < largest < np.inf:
                break
            for i in range(n):
                u[i] /= largest
            if k >= _WARM:
                growth *= largest
        for i in range(n):
            b[i] = kept[i]
        if not 0.0 < largest < np.inf:
            return largest
        for _ in range(_ROOTS):
            growth = math.sqrt(growth)
        return growth

    return radius

"""Arrays that begin with a line of the cache: vectors of theirs never lie in two."""

import math

import numpy as np

from herringbone.kernels.compiling.jit import kernel

_LINE = 64  # bytes
_REALS = 8  # of a line


def padded(count: int) -> int:
    """A count of reals that fills whole lines of the cache."""
    return (count + _REALS - 1) // _REALS * _REALS


in_lines = kernel(padded)
"""The same in kernels."""


def aligned(*shape: int, dtype: type[np.floating] = np.float64) -> np.ndarray:
    """Zeros that begin with a line of the cache."""
    size, line = math.prod(shape), _LINE // np.dtype(dtype).itemsize
    room = np.zeros(size + line, dtype)
    first = (-room.ctypes.data // room.itemsize) % line
    return room[first : first + size].reshape(shape)

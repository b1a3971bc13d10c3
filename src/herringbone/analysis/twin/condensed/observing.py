"""Outputs that are not affine, by their own parts' kernels, compiled."""

import numpy as np

from herringbone.cosim.loops.calls import c_call
from herringbone.kernels.compiling.jit import kernel

_REAL = 8
_call_outputs = c_call("address", "real")


@kernel
def call_parts(
    addresses: np.ndarray,
    first: np.ndarray,
    blocks: np.ndarray,
    times: np.ndarray,
    targets: np.ndarray,
    given: np.ndarray,
    read: np.ndarray,
    values: np.ndarray,
) -> None:
    """Write `values` (times, read), from what is `given` (times, targets).

    Args:
        addresses: of functions that write the outputs of parts at a time.
        first: where the blocks of these parts begin.
        blocks: of all parts; changed.
        times: [s].
        targets: places of the states and inputs that are given.
        given: of them.
        read: places of the outputs that are wanted.
        values: of them.
    """
    for row in range(times.size):
        for k in range(targets.size):
            blocks[targets[k]] = given[row, k]
        for p in range(addresses.size):
            _call_outputs(addresses[p], (blocks.ctypes.data + _REAL * first[p], times[row]))
        for k in range(read.size):
            values[row, k] = blocks[read[k]]

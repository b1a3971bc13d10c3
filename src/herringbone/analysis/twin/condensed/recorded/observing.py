"""Outputs that are not affine, by their own parts' kernels, compiled."""

from typing import NamedTuple

import numpy as np

from herringbone.cosim.loops.calls import c_call
from herringbone.kernels.compiling.jit import inlined, kernel

_REAL = 8
_call_outputs = c_call("address", "real")


class Shown(NamedTuple):
    """How outputs follow from affine rows.

    Attributes:
        still: (rows,) what is added to them: first of affine outputs, then of targets.
        here: places of the affine ones among the outputs.
        there: of the others.
        addresses, first, blocks, targets, read: see `call_parts`.
    """

    still: np.ndarray
    here: np.ndarray
    there: np.ndarray
    addresses: np.ndarray
    first: np.ndarray
    blocks: np.ndarray
    targets: np.ndarray
    read: np.ndarray


@inlined
def show(shown: Shown, t: float, rows: np.ndarray, values: np.ndarray) -> None:
    """Write the outputs at a time [s] from their rows."""
    count = shown.here.size
    for k in range(count):
        values[shown.here[k]] = rows[k]
    for k in range(shown.targets.size):
        shown.blocks[shown.targets[k]] = rows[count + k]
    for p in range(shown.addresses.size):
        _call_outputs(shown.addresses[p], (shown.blocks.ctypes.data + _REAL * shown.first[p], t))
    for k in range(shown.read.size):
        values[shown.there[k]] = shown.blocks[shown.read[k]]


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

"""The algorithms' compiled loops from many starts: one call for all columns of a matrix.

From start to start everything is put back but what an algorithm keeps beside parts and history.
"""

import numpy as np

from herringbone.cosim.layouts.jumps import Jumps
from herringbone.cosim.layouts.layout import Chunk, Layout
from herringbone.cosim.layouts.nodes import Buffers, Control, NodeLayout
from herringbone.cosim.layouts.starts import Starts
from herringbone.cosim.loops.calls import exchange_reals
from herringbone.cosim.loops.common import DONE
from herringbone.cosim.loops.nodes import run_iterated
from herringbone.cosim.loops.predict import Prediction, run_predicted
from herringbone.cosim.loops.stages import run_stages
from herringbone.kernels.compiling.jit import kernel

_REAL, _REFERENCE = 8, 4


@kernel
def put(starts: Starts, number: int) -> None:
    """Put everything back, and change what the start with this number changes."""
    every, values = starts.reference.ctypes.data, starts.values.ctypes.data
    for k in range(starts.memory.size):
        count = starts.first[k + 1] - starts.first[k]
        at = values + _REAL * starts.first[k]
        exchange_reals(starts.set_real, starts.memory[k], every, count, at)
    one = starts.place.ctypes.data + _REFERENCE * number
    at = starts.value.ctypes.data + _REAL * number
    exchange_reals(starts.set_real, starts.memory[starts.array[number]], one, 1, at)


@kernel
def take(starts: Starts, number: int) -> None:
    """Keep what is wanted after the macro step from the start with this number."""
    at = starts.found.ctypes.data + _REAL * number * starts.found.shape[1]
    for k in range(starts.memory.size):
        count = starts.seen[k]
        every = starts.reference.ctypes.data
        exchange_reals(starts.get_real, starts.memory[k], every, count, at)
        at += _REAL * count


@kernel
def stages_from(
    starts: Starts, begin: int, layout: Layout, history: np.ndarray, order: int, chunk: Chunk
) -> tuple[int, int, int]:
    """`run_stages` from each start.

    Args:
        starts: to begin from.
        begin: number of the first one.
        layout, history, order, chunk: see `run_stages`.

    Returns:
        Status, number of the start that failed or how many there are, part that failed (or -1).
    """
    for number in range(begin, starts.array.size):
        put(starts, number)
        status, _, culprit = run_stages(layout, history, order, chunk)
        if status != DONE:
            return status, number, culprit
        take(starts, number)
    return DONE, starts.array.size, -1


@kernel
def predicted_from(
    starts: Starts,
    begin: int,
    layout: Layout,
    prediction: Prediction,
    history: np.ndarray,
    chunk: Chunk,
) -> tuple[int, int, int]:
    """`run_predicted` from each start; the result is that of `stages_from`."""
    for number in range(begin, starts.array.size):
        put(starts, number)
        status, _, culprit = run_predicted(layout, prediction, history, chunk)
        if status != DONE:
            return status, number, culprit
        take(starts, number)
    return DONE, starts.array.size, -1


@kernel
def iterated_from(
    starts: Starts,
    begin: int,
    layout: Layout,
    nodes: NodeLayout,
    buffers: Buffers,
    correction: np.ndarray,
    control: Control,
    jumps: Jumps,
    chunk: Chunk,
) -> tuple[int, int, int]:
    """`run_iterated` from each start; the result is that of `stages_from`."""
    for number in range(begin, starts.array.size):
        put(starts, number)
        status, _, culprit = run_iterated(layout, nodes, buffers, correction, control, jumps, chunk)
        if status != DONE:
            return status, number, culprit
        take(starts, number)
    return DONE, starts.array.size, -1

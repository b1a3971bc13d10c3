"""Channels over a step: their values at its nodes, continued, and as inputs of matrices.

Indices are those of loops wherever it can be: of sums the compiler does not know that they are not
negative, and asks each time.
"""

import numpy as np

from herringbone.kernels.compiling.jit import inlined

_ROUNDED = 1e-13
"""Of a channel: what it bends by less over a step is rounding."""


@inlined
def predict(ahead: np.ndarray, on: bool, values: int, u: np.ndarray, to: np.ndarray) -> None:
    """Write the laws' values at the nodes of the next step: the last one's, continued or held.

    Args:
        ahead: (nodes, nodes of the last step), see `Fixed`.
        on: if they are continued.
        values: how many; the first channels.
        u: (channels, nodes) of the last step.
        to: (channels, nodes).
    """
    count = len(ahead)
    last = count - 1
    for value in range(values):
        own, next_ = u[value], to[value]
        end, moves = own[last], False
        for i in range(count):
            moves |= own[i] != end
            next_[i] = end
        if moves and on:
            for i in range(1, count):
                row, total = ahead[i], end
                for n in range(last):
                    total += row[n] * (own[n] - end)
                next_[i] = total


@inlined
def inputs(
    nodes: np.ndarray,
    least: np.ndarray,
    u: np.ndarray,
    first: int,
    end: int,
    v: np.ndarray,
    chosen: np.ndarray,
) -> int:
    """Write the inputs of some channels, see `Rungs`.

    Args:
        nodes: (nodes,) places in a step.
        least: (channels,) size of an input that does nothing, see `Table`.
        u: (channels, nodes) their values.
        first, end: which channels.
        v: (channels, nodes) written.
        chosen: (channels x nodes,) places in `v` of what does something.

    Returns:
        How many these are.
    """
    count, n = nodes.size, 0
    last = count - 1
    for channel in range(first, end):
        own, to, at, size = u[channel], v[channel], channel * count, least[channel]
        start = own[0]
        rise, bend = own[last] - start, 0.0
        for i in range(1, last):
            off = own[i] - start - nodes[i] * rise
            to[i] = off
            bend += abs(off)
        to[0], to[last] = start, rise
        if not abs(start) <= size:  # what is not finite is an input
            chosen[n] = at
            n += 1
        if not abs(rise) <= size:
            chosen[n] = at + last
            n += 1
        if not bend <= max(size, _ROUNDED * (abs(start) + abs(rise))):
            for i in range(1, last):
                chosen[n] = at + i
                n += 1
    return n

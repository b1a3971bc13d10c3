"""Jumps and bends of outputs inside a macro step, seen by the differences of its nodes.

The difference of order p over the p + 1 nodes of a smooth output falls with h^p, that of one that
bends inside the step with h, and that of one that jumps stays. It is small by chance where a bend
lies in the middle of the nodes; the sum of the second differences is not, which falls with h^2, h
and not at all. A step in which one of both is far more than in the steps before is taken back, and
divided; see `algorithms.dividing.divided`.
"""

import numpy as np

from herringbone.cosim.layouts.jumps import Jumps
from herringbone.cosim.layouts.layout import Layout
from herringbone.cosim.layouts.nodes import Buffers, NodeLayout
from herringbone.cosim.loops.node_pass import restore
from herringbone.kernels.compiling.jit import inlined, seldom

JUMPED = 6
"""Status: outputs jump or bend inside of a step, which was taken back."""
FLOOR = 1e-5
"""Difference over the largest value of the unit, up to which it is nothing."""
SUDDEN, _KEPT = 2.0, 0.98
"""Differences of so many times the usual ones are sudden; share of these that is kept from step to
step. What swings has differences near zero twice a period: of periods up to a thousand steps the
usual ones outlast that, k^(n / 4) > sin(2 pi / n) / 2; of longer ones all are below FLOOR."""
_REST = 10.0
"""Differences that the residual of corrections makes, over it."""


@inlined
def jumped(jumps: Jumps, nodes: NodeLayout, buffers: Buffers, rest: float) -> bool:
    """True if an output changes in the present step as no smooth one does.

    Args:
        jumps: is told the differences.
        nodes, buffers: as the last pass left them.
        rest: residual that corrections may leave, relative.
    """
    if jumps.output.size == 0:
        return False
    for k in range(jumps.output.size):
        _differences(jumps, nodes.degree, buffers.nodes, k)
    for k in range(jumps.output.size):
        least = max(FLOOR, _REST * rest) * jumps.largest[jumps.group[k]]
        for row in range(2):
            if jumps.found[row, k] > max(jumps.limit[row, k], least):
                return True
    return False


@inlined
def _differences(jumps: Jumps, degree: int, values: np.ndarray, k: int) -> None:
    """Write those of an output, and its largest value."""
    i, g = jumps.output[k], jumps.group[k]
    highest, bend = 0.0, 0.0
    for j in range(degree + 1):
        highest += jumps.weights[j] * values[j, i]
        jumps.largest[g] = max(jumps.largest[g], abs(values[j, i]))
        if j > 1:
            bend += abs(values[j, i] - 2.0 * values[j - 1, i] + values[j - 2, i])
    jumps.found[0, k], jumps.found[1, k] = abs(highest), bend


@inlined
def learn(jumps: Jumps) -> None:
    """Take the differences of a whole macro step as usual."""
    for k in range(jumps.output.size if jumps.learns[0] else 0):
        for row in range(2):
            jumps.usual[row, k] = max(_KEPT * jumps.usual[row, k], jumps.found[row, k])
            jumps.limit[row, k] = SUDDEN * jumps.usual[row, k]


@inlined
def take_back(layout: Layout, nodes: NodeLayout, buffers: Buffers) -> int:
    """Parts and history as before the step; -1, or the part that refused."""
    history = buffers.history
    for row in range(history.shape[0] - 1):
        for i in range(history.shape[1]):
            history[row, i] = history[row + 1, i]
    return restore(layout, nodes, buffers, True)


@seldom
def step_back(layout: Layout, nodes: NodeLayout, buffers: Buffers) -> int:
    """`take_back`, by itself."""
    return take_back(layout, nodes, buffers)

"""Interface Jacobian of the iterated algorithms, by differences over doStep."""

import numpy as np

from herringbone.cosim.layouts.layout import Layout
from herringbone.cosim.layouts.nodes import Buffers, NodeLayout
from herringbone.cosim.loops.node_pass import begin, one_pass, restore
from herringbone.kernels.jit import seldom


@seldom
def sensitivity(  # noqa: PLR0912 (loops instead of array expressions)
    layout: Layout,
    nodes: NodeLayout,
    buffers: Buffers,
    jacobian: np.ndarray,
    off: np.ndarray,
    change: np.ndarray,
    base: np.ndarray,
    first: np.ndarray,
    order: int,
    t: float,
    h: float,
    known: int,
) -> int:
    """dG/dU by forward differences over doStep, (unknowns p) squared; states are restored after.

    Args:
        jacobian: is written.
        off: (outputs,) is written: by how much the first pass, repeated last, gives other values.
        change: of each unknown.
        base, first: room for the residual and the signals at the nodes, as long as these.

    Returns:
        -1, or the part that failed.
    """
    failed = begin(layout, nodes, buffers, order, known, t, h, True)
    if failed < 0:
        failed = one_pass(layout, nodes, buffers, t, h)
    count = nodes.unknown.size
    for k in range(base.shape[0]):
        for i in range(count):
            base[k, i] = buffers.rest[k, i]
    for k in range(first.shape[0]):
        for i in range(first.shape[1]):
            first[k, i] = buffers.nodes[k, i]
    for column in range(jacobian.shape[1]):
        if failed >= 0:
            break
        k, i = column // count, column % count
        failed = restore(layout, nodes, buffers, False)
        buffers.trial[k, i] += change[i]
        if failed < 0:
            failed = one_pass(layout, nodes, buffers, t, h)
        buffers.trial[k, i] -= change[i]
        for row in range(jacobian.shape[0]):
            difference = buffers.rest[row // count, row % count] - base[row // count, row % count]
            same = 1.0 if row == column else 0.0
            jacobian[row, column] = difference / change[i] + same
    if failed < 0:
        failed = restore(layout, nodes, buffers, False)
    if failed < 0:
        failed = one_pass(layout, nodes, buffers, t, h)
    for i in range(off.size):
        off[i] = 0.0
        for k in range(nodes.degree + 1):
            off[i] = max(off[i], abs(buffers.nodes[k, i] - first[k, i]))
    refused = restore(layout, nodes, buffers, True)
    return failed if failed >= 0 else refused

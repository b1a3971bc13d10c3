"""Interface Jacobian of the iterated algorithms, by differences over doStep."""

import numpy as np

from herringbone.cosim.layouts.layout import Layout
from herringbone.cosim.layouts.nodes import Buffers, NodeLayout
from herringbone.cosim.loops.node_pass import begin, one_pass, restore
from herringbone.kernels.compiling.jit import inlined, seldom


@inlined
def keep(buffers: Buffers, base: np.ndarray, first: np.ndarray) -> None:
    """Keep the residual and the signals at the nodes."""
    for k in range(base.shape[0]):
        for i in range(base.shape[1]):
            base[k, i] = buffers.rest[k, i]
    for k in range(first.shape[0]):
        for i in range(first.shape[1]):
            first[k, i] = buffers.nodes[k, i]


@inlined
def write_column(
    buffers: Buffers, base: np.ndarray, jacobian: np.ndarray, column: int, change: float
) -> None:
    """A column of the Jacobian, from the residual and the one without the change."""
    count = base.shape[1]
    for row in range(jacobian.shape[0]):
        difference = buffers.rest[row // count, row % count] - base[row // count, row % count]
        same = 1.0 if row == column else 0.0
        jacobian[row, column] = difference / change + same


@seldom
def sensitivity(
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
    count, columns = nodes.unknown.size, jacobian.shape[1]
    for column in range(-1, columns + 1):  # the first and the last pass change nothing
        if failed < 0 and column >= 0:
            failed = restore(layout, nodes, buffers, False)
        if failed >= 0:
            break
        changed = 0 <= column < columns
        k, i = (column // count, column % count) if changed else (0, 0)
        if changed:
            buffers.trial[k, i] += change[i]
        failed = one_pass(layout, nodes, buffers, t, h)
        if column < 0:
            keep(buffers, base, first)
        elif changed:
            buffers.trial[k, i] -= change[i]
            write_column(buffers, base, jacobian, column, change[i])
    for i in range(off.size):
        off[i] = 0.0
        for k in range(nodes.degree + 1):
            off[i] = max(off[i], abs(buffers.nodes[k, i] - first[k, i]))
    refused = restore(layout, nodes, buffers, True)
    return failed if failed >= 0 else refused

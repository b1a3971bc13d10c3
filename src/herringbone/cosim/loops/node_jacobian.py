"""Interface Jacobian of the iterated algorithms, by differences over doStep.

A column is what outputs change with one unknown: only bodies that take it step anew, and elements
that see it. All other parts give what they gave without the change.
"""

import numpy as np

from herringbone.cosim.layouts.layout import Layout
from herringbone.cosim.layouts.nodes import Buffers, NodeLayout
from herringbone.cosim.layouts.reach import Reach
from herringbone.cosim.loops.common import LAST_GOOD
from herringbone.cosim.loops.node_pass import (
    begin,
    one_pass,
    put_trial,
    restore,
    restore_part,
    step_group,
    write_residual,
)
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
def _give_again(layout: Layout, buffers: Buffers, p: int, first: np.ndarray) -> None:
    """Outputs of a part at the nodes as they were kept."""
    for k in range(1, first.shape[0]):
        for i in range(layout.output_first[p], layout.output_first[p + 1]):
            buffers.nodes[k, i] = first[k, i]


@inlined
def _changed_pass(
    layout: Layout, nodes: NodeLayout, buffers: Buffers, reach: Reach, i: int,
    first: np.ndarray, t: float, h: float,
) -> int:  # fmt: skip
    """As `one_pass`, where only unknown i is another than in the pass that was kept."""
    buffers.counts[0] += 1
    for group in (nodes.bodies, nodes.elements):
        for p in group:
            if reach.sees[i, p] and restore_part(layout, nodes, buffers, p) > LAST_GOOD:
                return p
    put_trial(nodes, buffers)
    bodies = reach.body[reach.body_first[i] : reach.body_first[i + 1]]
    failed = step_group(layout, nodes, buffers, bodies, t, h)
    for p in nodes.bodies:
        if not reach.sees[i, p]:
            _give_again(layout, buffers, p, first)
    for e in range(nodes.elements.size):
        if failed >= 0:
            return failed
        if reach.sees[i, nodes.elements[e]]:
            failed = step_group(layout, nodes, buffers, nodes.elements[e : e + 1], t, h)
        else:
            _give_again(layout, buffers, nodes.elements[e], first)
    write_residual(nodes, buffers)
    return failed


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
    reach: Reach,
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
        reach: parts that see a change of each unknown.
        jacobian: is written.
        off: (outputs,) is written: by how much the first pass, repeated last, gives other values.
        change: of each unknown.
        base, first: room for the residual and the signals at the nodes, as long as these.

    Returns:
        -1, or the part that failed.
    """
    failed = begin(layout, nodes, buffers, order, known, t, h, True)
    count, columns = nodes.unknown.size, jacobian.shape[1]
    for again in range(2):
        if failed < 0 and again:
            failed = restore(layout, nodes, buffers, False)
        if failed < 0:
            failed = one_pass(layout, nodes, buffers, t, h)
        if again:
            break
        keep(buffers, base, first)
        for column in range(columns):
            if failed >= 0:
                break
            k, i = column // count, column % count
            buffers.trial[k, i] += change[i]
            failed = _changed_pass(layout, nodes, buffers, reach, i, first, t, h)
            buffers.trial[k, i] -= change[i]
            write_column(buffers, base, jacobian, column, change[i])
    for i in range(off.size):
        off[i] = 0.0
        for k in range(nodes.degree + 1):
            off[i] = max(off[i], abs(buffers.nodes[k, i] - first[k, i]))
    refused = restore(layout, nodes, buffers, True)
    return failed if failed >= 0 else refused

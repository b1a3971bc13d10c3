"""Compiled loop of the iterated algorithms: signals at nodes, rollback, one frozen correction.

A macro step of degree p: the unknowns U are the values at c = 1/p ... 1 of all outputs that feed
bodies. One pass steps the bodies on U, then the elements on the bodies' motions at the nodes, which
gives G(U). From a prediction, each correction is U += C (G - U), after which all parts are restored
and step again. C = I is the plain fixed point, C = (I - dG/dU)^-1 one Newton step with a frozen
Jacobian. After the last pass the parts are at the end of the step, and G - U is what is left over.
"""

import numpy as np

from herringbone.cosim.energy.loop import is_watched
from herringbone.cosim.energy.nodes import watch_nodes
from herringbone.cosim.layouts.jumps import Jumps
from herringbone.cosim.layouts.layout import Chunk, Layout
from herringbone.cosim.layouts.nodes import Buffers, Control, NodeLayout
from herringbone.cosim.loops.common import (
    DONE,
    LAST_GOOD,
    NOT_FINITE,
    PART_FAILED,
    get_outputs,
    is_slow,
    not_finite,
    record_row,
)
from herringbone.cosim.loops.jumps import JUMPED, jumped, learn, take_back
from herringbone.cosim.loops.node_pass import begin, one_pass, restore
from herringbone.cosim.loops.slow import finish_slow, trace_slow
from herringbone.kernels.compiling.jit import inlined, kernel

REFRESH = 3
"""Status: the correction no longer contracts; a new Jacobian is wanted."""


@inlined
def residual(buffers: Buffers) -> float:
    """Largest residual, in units of the scale; infinite if it is not finite."""
    largest = 0.0
    for k in range(buffers.rest.shape[0]):
        for i in range(buffers.rest.shape[1]):
            size = abs(buffers.rest[k, i]) / buffers.scale[i]
            if size - size != 0.0:
                return np.inf
            largest = max(largest, size)
    return largest


@inlined
def correct(buffers: Buffers, correction: np.ndarray) -> None:
    """U += C (G - U), by four columns of C at once: sums of several rows go side by side."""
    nodes, count, room = buffers.rest.shape[0], buffers.scale.size, buffers.values
    whole, size = count - count % 4, nodes * count
    for row in range(size):
        room[row] = 0.0
    for node in range(nodes):
        rest, columns = buffers.rest[node], correction[node * count : (node + 1) * count]
        for i in range(0, whole, 4):
            a, b, c, d = rest[i], rest[i + 1], rest[i + 2], rest[i + 3]
            of_a, of_b, of_c, of_d = columns[i], columns[i + 1], columns[i + 2], columns[i + 3]
            for row in range(size):
                found = room[row] + of_a[row] * a
                room[row] = ((found + of_b[row] * b) + of_c[row] * c) + of_d[row] * d
        for i in range(whole, count):
            a, of_a = rest[i], columns[i]
            for row in range(size):
                room[row] += of_a[row] * a
    for node in range(nodes):
        for i in range(count):
            buffers.trial[node, i] += room[node * count + i]


@inlined
def finish(layout: Layout, nodes: NodeLayout, buffers: Buffers) -> None:
    """The values at the end of the step become the newest of the history, rates those before."""
    for i in range(buffers.rates.shape[1]):
        buffers.rates[0, i] = buffers.rates[1, i]
    for p in range(layout.component.size):
        for i in range(layout.output_first[p], layout.output_first[p + 1]):
            buffers.history[0, i] = buffers.nodes[nodes.degree, i]


@inlined
def grow_scale(nodes: NodeLayout, buffers: Buffers) -> None:
    """The scale becomes the largest value of the same unit at communication points so far."""
    for i in range(nodes.unknown.size):
        size = abs(buffers.history[0, nodes.unknown[i]])
        if size > buffers.scale[i]:
            for k in range(nodes.unknown.size):
                if nodes.group[k] == nodes.group[i]:
                    buffers.scale[k] = size


@inlined
def converge(
    layout: Layout,
    nodes: NodeLayout,
    buffers: Buffers,
    correction: np.ndarray,
    control: Control,
    t: float,
    h: float,
) -> tuple[int, float]:
    """Correct one macro step until the residual is small; who failed (or -1), and contraction."""
    failed, before, contraction = -1, 0.0, 0.0
    for done in range(control.most + 1):
        if done > 0:
            if failed >= 0 or (done > control.corrections and before <= control.tolerance):
                break
            correct(buffers, correction)
            failed = restore(layout, nodes, buffers, False)
        if failed < 0:
            failed = one_pass(layout, nodes, buffers, t, h)
        after = residual(buffers)
        if done > 0:
            buffers.counts[1] += 1
            if before > control.tolerance:
                contraction = max(contraction, after / before)
        before = after
    buffers.worst[0] = max(buffers.worst[0], before)
    buffers.worst[1] = max(buffers.worst[1], contraction)
    return failed, contraction


@inlined
def _attempt(
    layout: Layout, nodes: NodeLayout, buffers: Buffers, correction: np.ndarray, control: Control,
    jumps: Jumps, known: int, t: float, h: float,
) -> tuple[int, int, float]:  # fmt: skip
    """Try a macro step, and take it back where outputs jump; status, who failed, contraction."""
    contraction = 0.0
    failed = begin(layout, nodes, buffers, control.order, known, t, h, False)
    if failed < 0:
        failed, contraction = converge(layout, nodes, buffers, correction, control, t, h)
    if failed >= 0:
        return PART_FAILED, failed, contraction
    if jumped(jumps, nodes, buffers, control.tolerance):
        failed = take_back(layout, nodes, buffers)
        return (PART_FAILED if failed >= 0 else JUMPED), failed, contraction
    learn(jumps)
    return DONE, -1, contraction


@kernel
def run_iterated(
    layout: Layout,
    nodes: NodeLayout,
    buffers: Buffers,
    correction: np.ndarray,
    control: Control,
    jumps: Jumps,
    chunk: Chunk,
) -> tuple[int, int, int]:
    """Run macro steps; the result is that of `loops.stages.run_stages`.

    Args:
        correction: C by columns, (unknowns p) squared.

    Status REFRESH ends the chunk after a macro step that is complete, JUMPED before one that was
    taken back.
    """
    h = chunk.h
    for n in range(chunk.start, chunk.start + chunk.count):
        t, row = chunk.t0 + n * h, record_row(chunk, n)
        status, failed, contraction = _attempt(
            layout, nodes, buffers, correction, control, jumps, n + 1, t, h
        )
        if status != DONE:
            return status, n, failed
        finish(layout, nodes, buffers)
        buffers.spacing[1] = buffers.spacing[0]
        buffers.spacing[0] = 1.0
        for node in range(1, nodes.degree + 1):
            trace_slow(layout.slow, layout, buffers.nodes[node], n, node, nodes.degree)
        failed = finish_slow(layout.slow, layout, buffers.history, chunk, n)
        if failed >= 0:
            return PART_FAILED, n, failed
        culprit = not_finite(layout, buffers.history)
        if culprit >= 0:
            return NOT_FINITE, n + 1, culprit
        grow_scale(nodes, buffers)
        if is_watched(chunk.energy, h):
            watch_nodes(chunk.energy, buffers.nodes, buffers.trial, h)
        for p in range(layout.component.size if row >= 0 else 0):
            fast = not is_slow(layout.slow, p)
            if fast and get_outputs(layout, buffers.history, p, chunk.records, row) > LAST_GOOD:
                return PART_FAILED, n + 1, p
        if contraction > control.slow:
            return REFRESH, n + 1, -1
    return DONE, chunk.start + chunk.count, -1

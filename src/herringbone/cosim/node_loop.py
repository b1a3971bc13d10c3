"""Compiled loop of the iterated algorithms: signals at nodes, rollback, one frozen correction.

A macro step of degree p: the unknowns U are the values at c = 1/p ... 1 of all outputs that feed
bodies. One pass steps the bodies on U, then the elements on the bodies' motions at the nodes, which
gives G(U). From a prediction, each correction is U += C (G - U), after which all parts are restored
and step again. C = I is the plain fixed point, C = (I - dG/dU)^-1 one Newton step with a frozen
Jacobian. After the last pass the parts are at the end of the step, and G - U is what is left over.
"""

import numpy as np

from herringbone.cosim.calls import do_step, state_call
from herringbone.cosim.loop import (
    DONE,
    LAST_GOOD,
    NOT_FINITE,
    PART_FAILED,
    exchange,
    get_outputs,
    not_finite,
    record_row,
    signal,
    start_step,
)
from herringbone.cosim.node_plan import Buffers, Control, NodePlan
from herringbone.cosim.plan import Chunk, Plan
from herringbone.kernels.jit import kernel

REFRESH = 3
"""Status: the correction no longer contracts; a new Jacobian is wanted."""


@kernel
def save(plan: Plan, nodes: NodePlan, buffers: Buffers) -> int:
    """Save the state of all parts that can; -1, or the part that refused."""
    at = buffers.states.ctypes.data
    for group in (nodes.bodies, nodes.elements, nodes.sources):
        for p in group:
            if nodes.get_state[p] == 0:
                continue
            if buffers.states[p] != 0:
                state_call(nodes.free_state[p], plan.component[p], at + 8 * p)
            if state_call(nodes.get_state[p], plan.component[p], at + 8 * p) > LAST_GOOD:
                return p
    return -1


@kernel
def restore(plan: Plan, nodes: NodePlan, buffers: Buffers, sources: bool) -> int:
    """Restore the state of bodies and elements, and of sources; -1, or the part that refused."""
    buffers.counts[0] += 1
    for group in (nodes.bodies, nodes.elements, nodes.sources):
        for p in group:
            is_source = plan.input_first[p] == plan.input_first[p + 1]
            if nodes.get_state[p] == 0 or (is_source and not sources):
                continue
            status = state_call(nodes.set_state[p], plan.component[p], buffers.states[p])
            if status > LAST_GOOD:
                return p
    return -1


@kernel
def _set_from_nodes(plan: Plan, nodes: NodePlan, buffers: Buffers, p: int) -> int:
    """Set a part's inputs from the nodes: all of them, or one value if the part holds inputs."""
    first, end = plan.input_first[p], plan.input_first[p + 1]
    if first == end:
        return 0
    at, degree = plan.set_first[p], plan.degree[p]
    for node in range(degree + 1):
        for i in range(first, end):
            source = plan.input_source[i]
            if degree > 0:
                value = buffers.nodes[node, source]
            elif plan.at_end[p]:
                value = buffers.nodes[nodes.degree, source]
            else:
                value = 0.0
                for k in range(nodes.degree + 1):
                    value += nodes.weights[k] * buffers.nodes[k, source]
            plan.set_value[at] = value
            at += 1
    start = plan.set_first[p]
    return exchange(
        plan, p, plan.set_real, plan.set_reference, start, at - start, plan.set_value, start
    )


@kernel
def _get_to_nodes(plan: Plan, nodes: NodePlan, buffers: Buffers, p: int) -> int:
    """Get a part's connected outputs at the nodes; without nodes, interpolate to its end value."""
    first, end = plan.output_first[p], plan.output_first[p + 1]
    if first == end:
        return 0
    degree, at = nodes.degree, nodes.node_first[p]
    count = nodes.node_first[p + 1] - at
    if count > 0:
        status = exchange(
            plan, p, plan.get_real, nodes.node_reference, at, count, buffers.values, 0
        )
        k = 0
        for node in range(1, degree + 1):
            for i in range(first, end):
                buffers.nodes[node, i] = buffers.values[k]
                k += 1
        return status
    status = exchange(
        plan, p, plan.get_real, plan.output_reference, first, end - first, buffers.values, 0
    )
    for i in range(first, end):
        now, before = buffers.nodes[0, i], buffers.history[2, i]
        after = buffers.values[i - first]
        for node in range(1, degree + 1):
            c = node / degree
            bend = 0.5 * (after - 2.0 * now + before)
            buffers.nodes[node, i] = now + c * (0.5 * (after - before) + c * bend)
    return status


@kernel
def _step_group(
    plan: Plan, nodes: NodePlan, buffers: Buffers, group: np.ndarray, t: float, h: float
) -> int:
    """Set, step and get a group of parts that do not see each other; -1, or who failed."""
    for p in group:
        if _set_from_nodes(plan, nodes, buffers, p) > LAST_GOOD:
            return p
    for p in group:
        buffers.passes[p] += 1
        if do_step(plan.do_step[p], plan.component[p], t, h) > LAST_GOOD:
            return p
    for p in group:
        if _get_to_nodes(plan, nodes, buffers, p) > LAST_GOOD:
            return p
    return -1


@kernel
def one_pass(plan: Plan, nodes: NodePlan, buffers: Buffers, t: float, h: float) -> int:
    """Step bodies and elements on the trial values; writes the residual. -1, or who failed."""
    for k in range(nodes.degree):
        for i in range(nodes.unknown.size):
            buffers.nodes[k + 1, nodes.unknown[i]] = buffers.trial[k, i]
    failed = _step_group(plan, nodes, buffers, nodes.bodies, t, h)
    if failed >= 0:
        return failed
    for e in range(nodes.elements.size):
        failed = _step_group(plan, nodes, buffers, nodes.elements[e : e + 1], t, h)
        if failed >= 0:
            return failed
    for k in range(nodes.degree):
        for i in range(nodes.unknown.size):
            found = buffers.nodes[k + 1, nodes.unknown[i]]
            buffers.rest[k, i] = found - buffers.trial[k, i]
    return -1


@kernel
def begin(
    plan: Plan,
    nodes: NodePlan,
    buffers: Buffers,
    order: int,
    known: int,
    t: float,
    h: float,
    trial: bool,
) -> int:
    """Save, step the sources, predict the unknowns; -1, or who failed.

    In a trial that will be taken back, sources that cannot be restored hold their outputs.
    """
    start_step(buffers.history)
    for i in range(buffers.history.shape[1]):
        buffers.nodes[0, i] = buffers.history[1, i]
    failed = save(plan, nodes, buffers)
    if failed >= 0:
        return failed
    for k in range(nodes.degree):
        c = (k + 1) / nodes.degree
        for i in range(nodes.unknown.size):
            buffers.trial[k, i] = signal(buffers.history, nodes.unknown[i], 0, order, known, c)
    for s in range(nodes.sources.size):
        p = nodes.sources[s]
        if trial and nodes.get_state[p] == 0:
            for i in range(plan.output_first[p], plan.output_first[p + 1]):
                buffers.nodes[1:, i] = buffers.nodes[0, i]
            continue
        failed = _step_group(plan, nodes, buffers, nodes.sources[s : s + 1], t, h)
        if failed >= 0:
            return failed
    return -1


@kernel
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


@kernel
def correct(buffers: Buffers, correction: np.ndarray) -> None:
    """U += C (G - U)."""
    count = buffers.scale.size
    for row in range(correction.shape[0]):
        total = 0.0
        for k in range(buffers.rest.shape[0]):
            for i in range(count):
                total += correction[row, k * count + i] * buffers.rest[k, i]
        buffers.trial[row // count, row % count] += total


@kernel
def finish(plan: Plan, nodes: NodePlan, buffers: Buffers) -> None:
    """The values at the end of the step become the newest of the history."""
    for p in range(plan.component.size):
        for i in range(plan.output_first[p], plan.output_first[p + 1]):
            buffers.history[0, i] = buffers.nodes[nodes.degree, i]


@kernel
def _converge(
    plan: Plan,
    nodes: NodePlan,
    buffers: Buffers,
    correction: np.ndarray,
    control: Control,
    t: float,
    h: float,
) -> tuple[int, float]:
    """Correct one macro step until the residual is small; who failed (or -1), and contraction."""
    failed = one_pass(plan, nodes, buffers, t, h)
    before, contraction = residual(buffers), 0.0
    for done in range(control.most):
        if failed >= 0 or (done >= control.corrections and before <= control.tolerance):
            break
        correct(buffers, correction)
        failed = restore(plan, nodes, buffers, False)
        if failed < 0:
            failed = one_pass(plan, nodes, buffers, t, h)
        after = residual(buffers)
        if before > control.tolerance:
            contraction = max(contraction, after / before)
        before = after
        buffers.counts[1] += 1
    buffers.worst[0] = max(buffers.worst[0], before)
    buffers.worst[1] = max(buffers.worst[1], contraction)
    return failed, contraction


@kernel
def run_iterated(
    plan: Plan,
    nodes: NodePlan,
    buffers: Buffers,
    correction: np.ndarray,
    control: Control,
    chunk: Chunk,
) -> tuple[int, int, int]:
    """Run macro steps; the result is that of `loop.run_stages`.

    Args:
        correction: C, (unknowns p) squared.

    Status REFRESH ends the chunk after a macro step that is complete.
    """
    h = chunk.h
    for n in range(chunk.start, chunk.start + chunk.count):
        t, row, contraction = chunk.t0 + n * h, record_row(chunk, n), 0.0
        failed = begin(plan, nodes, buffers, control.order, n + 1, t, h, False)
        if failed < 0:
            failed, contraction = _converge(plan, nodes, buffers, correction, control, t, h)
        if failed >= 0:
            return PART_FAILED, n, failed
        finish(plan, nodes, buffers)
        culprit = not_finite(plan, buffers.history)
        if culprit >= 0:
            return NOT_FINITE, n + 1, culprit
        for p in range(plan.component.size if row >= 0 else 0):
            if get_outputs(plan, buffers.history, p, chunk.records, row) > LAST_GOOD:
                return PART_FAILED, n + 1, p
        if contraction > control.slow:
            return REFRESH, n + 1, -1
    return DONE, chunk.start + chunk.count, -1


@kernel
def sensitivity(
    plan: Plan,
    nodes: NodePlan,
    buffers: Buffers,
    jacobian: np.ndarray,
    change: np.ndarray,
    order: int,
    t: float,
    h: float,
    known: int,
) -> int:
    """dG/dU by forward differences over doStep, (unknowns p) squared; all is restored after.

    Args:
        jacobian: is written.
        change: of each unknown.

    Returns:
        -1, or the part that failed.
    """
    saved = buffers.history.copy()
    failed = begin(plan, nodes, buffers, order, known, t, h, True)
    if failed < 0:
        failed = one_pass(plan, nodes, buffers, t, h)
    count = nodes.unknown.size
    base = buffers.rest.copy()
    for column in range(jacobian.shape[1]):
        if failed >= 0:
            break
        k, i = column // count, column % count
        failed = restore(plan, nodes, buffers, False)
        buffers.trial[k, i] += change[i]
        if failed < 0:
            failed = one_pass(plan, nodes, buffers, t, h)
        buffers.trial[k, i] -= change[i]
        for row in range(jacobian.shape[0]):
            difference = buffers.rest[row // count, row % count] - base[row // count, row % count]
            same = 1.0 if row == column else 0.0
            jacobian[row, column] = difference / change[i] + same
    if failed < 0:
        failed = restore(plan, nodes, buffers, True)
    buffers.history[:] = saved
    return failed

"""One pass of the iterated algorithms: all parts step once on trial values at the nodes.

A macro step of degree p: the unknowns U are the values at c = 1/p ... 1 of all outputs that feed
bodies. One pass steps the bodies on U, then the elements on the bodies' motions at the nodes, which
gives G(U). Before it, the states are saved and U is predicted.
"""

import numpy as np

from herringbone.cosim.layouts.layout import Layout
from herringbone.cosim.layouts.nodes import Buffers, NodeLayout
from herringbone.cosim.loops.calls import do_step, state_call
from herringbone.cosim.loops.common import LAST_GOOD, exchange, start_step
from herringbone.cosim.loops.derivatives import (
    cubic,
    get_rates,
    gives_rates,
    sample,
    sample_count,
    set_derivatives,
    write_input,
)
from herringbone.cosim.loops.slow import predict_slow_nodes
from herringbone.kernels.compiling.jit import inlined


@inlined
def save_part(layout: Layout, nodes: NodeLayout, buffers: Buffers, p: int) -> int:
    """Save the state of a part that can; FMI status."""
    at = buffers.states.ctypes.data + 8 * p
    if buffers.states[p] != 0:
        state_call(nodes.free_state[p], layout.component[p], at)
    return state_call(nodes.get_state[p], layout.component[p], at)


@inlined
def restore_part(layout: Layout, nodes: NodeLayout, buffers: Buffers, p: int) -> int:
    """Restore the state of a part that can; FMI status."""
    if nodes.get_state[p] == 0:
        return 0
    return state_call(nodes.set_state[p], layout.component[p], buffers.states[p])


@inlined
def save(layout: Layout, nodes: NodeLayout, buffers: Buffers) -> int:
    """Save the state of all parts that can; -1, or the part that refused."""
    for group in (nodes.bodies, nodes.elements, nodes.sources):
        for p in group:
            if nodes.get_state[p] != 0 and save_part(layout, nodes, buffers, p) > LAST_GOOD:
                return p
    return -1


@inlined
def restore(layout: Layout, nodes: NodeLayout, buffers: Buffers, sources: bool) -> int:
    """Restore the state of bodies and elements, and of sources; -1, or the part that refused."""
    buffers.counts[0] += 1
    for group in (nodes.bodies, nodes.elements, nodes.sources):
        for p in group:
            is_source = layout.input_first[p] == layout.input_first[p + 1]
            if is_source and not sources:
                continue
            if restore_part(layout, nodes, buffers, p) > LAST_GOOD:
                return p
    return -1


@inlined
def set_from_nodes(layout: Layout, buffers: Buffers, p: int, h: float) -> int:
    """Set a part's inputs from the nodes: all of them, or the polynomial that the part takes."""
    first, end = layout.input_first[p], layout.input_first[p + 1]
    if first == end:
        return 0
    start, degree, signals = layout.set_first[p], layout.degree[p], layout.derivatives
    for i in range(end - first):
        source = layout.input_source[first + i]
        if degree == 0:
            for node in range(sample_count(signals)):
                sample(signals, node, buffers.nodes[node, source])
            write_input(signals, layout, p, i, h)
        for node in range(degree + 1 if degree > 0 else 0):
            layout.set_value[start + node * (end - first) + i] = buffers.nodes[node, source]
    count = (degree + 1) * (end - first)
    status = exchange(
        layout, p, layout.set_real, layout.set_reference, start, count, layout.set_value, start
    )
    return max(status, set_derivatives(signals, layout, p))


@inlined
def get_to_nodes(layout: Layout, nodes: NodeLayout, buffers: Buffers, p: int, h: float) -> int:
    """Get a part's connected outputs at the nodes; without nodes, interpolate to its end value.

    With the rates at both ends, if the part gives them; else with the value before.
    """
    first, end = layout.output_first[p], layout.output_first[p + 1]
    if first == end:
        return 0
    degree, at = nodes.degree, nodes.node_first[p]
    count = nodes.node_first[p + 1] - at
    if count > 0:
        status = exchange(
            layout, p, layout.get_real, nodes.node_reference, at, count, buffers.values, 0
        )
        k = 0
        for node in range(1, degree + 1):
            for i in range(first, end):
                buffers.nodes[node, i] = buffers.values[k]
                k += 1
        return status
    status = exchange(
        layout, p, layout.get_real, layout.output_reference, first, end - first, buffers.values, 0
    )
    rated = gives_rates(layout.derivatives, p)
    if rated:
        status = max(status, get_rates(layout.derivatives, layout, p, buffers.rates[1]))
    for i in range(first, end):
        now, past, value = buffers.nodes[0, i], buffers.spacing[0], buffers.values[i - first]
        rise = value - now
        bend = (rise - (now - buffers.history[2, i]) / past) / (1.0 + past)
        for node in range(1, degree + 1):
            c = node / degree
            if rated:
                at_start, at_end = h * buffers.rates[0, i], h * buffers.rates[1, i]
                buffers.nodes[node, i] = cubic(now, value, at_start, at_end, c)
            else:
                buffers.nodes[node, i] = now + c * (rise + (c - 1.0) * bend)
    return status


@inlined
def step_group(
    layout: Layout, nodes: NodeLayout, buffers: Buffers, group: np.ndarray, t: float, h: float
) -> int:
    """Set, step and get a group of parts that do not see each other; -1, or who failed."""
    for p in group:
        if set_from_nodes(layout, buffers, p, h) > LAST_GOOD:
            return p
    for p in group:
        buffers.passes[p] += 1
        status = do_step(layout.do_step[p], layout.component[p], t, h)
        if status > LAST_GOOD:
            buffers.counts[2] = status
            return p
    for p in group:
        status = get_to_nodes(layout, nodes, buffers, p, h)
        if status > LAST_GOOD:  # of a part in a cell this may be that of its step
            buffers.counts[2] = status
            return p
    return -1


@inlined
def put_trial(nodes: NodeLayout, buffers: Buffers) -> None:
    """The trial values become those at the nodes."""
    for k in range(nodes.degree):
        for i in range(nodes.unknown.size):
            buffers.nodes[k + 1, nodes.unknown[i]] = buffers.trial[k, i]


@inlined
def write_residual(nodes: NodeLayout, buffers: Buffers) -> None:
    """What the parts gave at the nodes, less the trial values."""
    for k in range(nodes.degree):
        for i in range(nodes.unknown.size):
            found = buffers.nodes[k + 1, nodes.unknown[i]]
            buffers.rest[k, i] = found - buffers.trial[k, i]


@inlined
def one_pass(layout: Layout, nodes: NodeLayout, buffers: Buffers, t: float, h: float) -> int:
    """Step bodies and elements on the trial values; writes the residual. -1, or who failed."""
    put_trial(nodes, buffers)
    failed = step_group(layout, nodes, buffers, nodes.bodies, t, h)
    if failed >= 0:
        return failed
    for e in range(nodes.elements.size):
        failed = step_group(layout, nodes, buffers, nodes.elements[e : e + 1], t, h)
        if failed >= 0:
            return failed
    write_residual(nodes, buffers)
    return -1


@inlined
def _predicted(buffers: Buffers, i: int, order: int, c: float) -> float:
    """Output i at c of the macro step: extrapolation of its values at communication points."""
    history, past = buffers.history, buffers.spacing
    value = history[1, i]
    if order >= 1:
        first = (history[1, i] - history[2, i]) / past[0]
        value += c * first
        if order >= 2:
            before = (history[2, i] - history[3, i]) / past[1]
            value += c * (c + past[0]) * (first - before) / (past[0] + past[1])
    return value


@inlined
def _integrated(buffers: Buffers, i: int, rate: int, order: int, c: float, h: float) -> float:
    """Output i at c of the macro step: its value, and the integral of its predicted rate."""
    history, past = buffers.history, buffers.spacing
    mean = history[1, rate]
    if order >= 1:
        first = (history[1, rate] - history[2, rate]) / past[0]
        mean += 0.5 * c * first
        if order >= 2:
            before = (history[2, rate] - history[3, rate]) / past[1]
            bend = (first - before) / (past[0] + past[1])
            mean += c * (c / 3.0 + 0.5 * past[0]) * bend
    return history[1, i] + h * c * mean


@inlined
def _settle(nodes: NodeLayout, buffers: Buffers) -> None:
    """Unknowns of parts that have stepped already are what these gave."""
    for i in range(nodes.unknown.size):
        for k in range(nodes.degree if nodes.settled[i] else 0):
            buffers.trial[k, i] = buffers.nodes[k + 1, nodes.unknown[i]]


@inlined
def begin(
    layout: Layout,
    nodes: NodeLayout,
    buffers: Buffers,
    order: int,
    known: int,
    t: float,
    h: float,
    trial: bool,
) -> int:
    """Save, predict the unknowns, step the sources and what steps once; -1, or who failed.

    In a trial that will be taken back, sources that cannot be restored hold their outputs.
    """
    start_step(buffers.history)
    for i in range(buffers.history.shape[1]):
        buffers.nodes[0, i] = buffers.history[1, i]
    failed = save(layout, nodes, buffers)
    if failed >= 0:
        return failed
    for k in range(nodes.degree):
        c = (k + 1) / nodes.degree
        for i in range(nodes.unknown.size):
            if nodes.rate[i] >= 0:
                rate, at_most = nodes.rate[i], min(order, known - 1)
                guess = _integrated(buffers, nodes.unknown[i], rate, at_most, c, h)
            else:
                guess = _predicted(buffers, nodes.unknown[i], min(order, known - 1), c)
            buffers.trial[k, i] = guess
            buffers.nodes[k + 1, nodes.unknown[i]] = guess  # for parts that step on it once
    predict_slow_nodes(layout.slow, layout, buffers.nodes, buffers.history[1], known - 1, h)
    for s in range(nodes.sources.size):
        p = nodes.sources[s]
        if trial and nodes.get_state[p] == 0:
            for i in range(layout.output_first[p], layout.output_first[p + 1]):
                for node in range(1, nodes.degree + 1):
                    buffers.nodes[node, i] = buffers.nodes[0, i]
            continue
        failed = step_group(layout, nodes, buffers, nodes.sources[s : s + 1], t, h)
        if failed >= 0:
            return failed
    _settle(nodes, buffers)
    return -1

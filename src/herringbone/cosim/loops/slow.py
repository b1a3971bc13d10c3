"""What a compiled loop does with slow bodies: predict their motion, collect forces, step them."""

import numpy as np

from herringbone.cosim.layouts.layout import Chunk, Layout
from herringbone.cosim.layouts.slow import Slow
from herringbone.cosim.loops.calls import do_step
from herringbone.cosim.loops.common import LAST_GOOD, exchange, get_outputs, record_row
from herringbone.kernels.compiling.jit import inlined


@inlined
def slow_motion(slow: Slow, i: int, n: int, c: float, h: float) -> float:
    """Slow output i (of `slow.output`) at c of macro step n: by Taylor, from its rates.

    An output of which no rate is known is the parabola through its last three values.
    """
    multiple, past = slow.multiple[slow.owner[i]], slow.past
    steps = n % multiple + c
    rate, second = slow.rate[i], slow.second[i]
    if rate < 0:
        x, known = steps / multiple, n // multiple
        first, before = past[0, i] - past[1, i], past[1, i] - past[2, i]
        value = past[0, i]
        if known >= 1:
            value += x * first
        if known >= 2:
            value += 0.5 * x * (x + 1.0) * (first - before)
        return value
    value = past[0, i] + steps * h * past[0, rate]
    if second >= 0:
        value += 0.5 * (steps * h) ** 2 * past[0, second]
    return value


@inlined
def _remember(slow: Slow, k: int, values: np.ndarray) -> None:
    """A slow part has reached a communication point with these outputs."""
    for i in range(slow.output.size):
        if slow.owner[i] == k:
            slow.past[2, i], slow.past[1, i] = slow.past[1, i], slow.past[0, i]
            slow.past[0, i] = values[slow.output[i]]


@inlined
def _sample(slow: Slow, layout: Layout, k: int, sample: int, values: np.ndarray) -> None:
    """The present inputs of slow part k become a sample of its trace."""
    p = slow.parts[k]
    first, count = layout.input_first[p], layout.input_first[p + 1] - layout.input_first[p]
    at = slow.trace_first[k] + sample * count
    for i in range(count):
        slow.trace[at + i] = values[layout.input_source[first + i]]


@inlined
def start_slow(slow: Slow, layout: Layout, values: np.ndarray) -> None:
    """The run starts with these outputs."""
    for k in range(slow.parts.size):
        for _ in range(slow.past.shape[0]):
            _remember(slow, k, values)
        _sample(slow, layout, k, 0, values)


@inlined
def predict_slow(slow: Slow | None, layout: Layout, history: np.ndarray, n: int, h: float) -> None:
    """Outputs of slow parts at the end of macro step n."""
    if slow is None:
        return
    if n == 0:
        start_slow(slow, layout, history[1])
    for i in range(slow.output.size):
        history[0, slow.output[i]] = slow_motion(slow, i, n, 1.0, h)


@inlined
def predict_slow_nodes(
    slow: Slow | None, layout: Layout, nodes: np.ndarray, start: np.ndarray, n: int, h: float
) -> None:
    """Outputs of slow parts at the nodes of macro step n; the run starts with `start`."""
    if slow is None:
        return
    if n == 0:
        start_slow(slow, layout, start)
    degree = nodes.shape[0] - 1
    for node in range(1, degree + 1):
        for i in range(slow.output.size):
            value = slow_motion(slow, i, n, node / degree, h)
            nodes[node, slow.output[i]] = value


@inlined
def trace_slow(
    slow: Slow | None, layout: Layout, values: np.ndarray, n: int, node: int, per: int
) -> None:
    """Collect the inputs of slow parts at node / per of macro step n."""
    if slow is None:
        return
    for k in range(slow.parts.size):
        _sample(slow, layout, k, (n % slow.multiple[k]) * per + node, values)


@inlined
def _set_fitted(slow: Slow, layout: Layout, k: int) -> int:
    """Set the inputs of slow part k to the polynomial nearest to its trace; FMI status."""
    p = slow.parts[k]
    count = layout.input_first[p + 1] - layout.input_first[p]
    if count == 0:
        return 0
    samples = (slow.trace_first[k + 1] - slow.trace_first[k]) // count
    start = layout.set_first[p]
    for node in range(layout.degree[p] + 1):
        row = slow.fit_first[k] + node * samples
        for i in range(count):
            value = 0.0
            for s in range(samples):
                value += slow.fit[row + s] * slow.trace[slow.trace_first[k] + s * count + i]
            layout.set_value[start + node * count + i] = value
    total = count * (layout.degree[p] + 1)
    return exchange(
        layout, p, layout.set_real, layout.set_reference, start, total, layout.set_value, start
    )


@inlined
def finish_slow(
    slow: Slow | None, layout: Layout, history: np.ndarray, chunk: Chunk, n: int
) -> int:
    """Step the slow parts that macro step n brings to their communication point; -1, or who failed.

    All are recorded, if it is time for a row; those that wait as predicted.
    """
    if slow is None:
        return -1
    row = record_row(chunk, n)
    for k in range(slow.parts.size):
        p, multiple = slow.parts[k], slow.multiple[k]
        slow.waiting[p] = (n + 1) % multiple != 0
        if slow.waiting[p]:
            if row >= 0 and get_outputs(layout, history, p, chunk.records, row) > LAST_GOOD:
                return p
            continue
        t, h = chunk.t0 + (n + 1 - multiple) * chunk.h, multiple * chunk.h
        if _set_fitted(slow, layout, k) > LAST_GOOD:
            return p
        slow.taken[p] += 1
        if do_step(layout.do_step[p], layout.component[p], t, h) > LAST_GOOD:
            return p
        if get_outputs(layout, history, p, chunk.records, row) > LAST_GOOD:
            return p
        _remember(slow, k, history[0])
        _sample(slow, layout, k, 0, history[0])
    return -1

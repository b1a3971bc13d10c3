"""What a compiled loop does with slow bodies: predict their motion, collect forces, step them."""

import numpy as np

from herringbone.cosim.layouts.layout import Chunk, Plan
from herringbone.cosim.layouts.slow import Slow
from herringbone.cosim.loops.calls import do_step
from herringbone.cosim.loops.common import LAST_GOOD, exchange, get_outputs, record_row
from herringbone.kernels.jit import inlined


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
def _sample(plan: Plan, k: int, sample: int, values: np.ndarray) -> None:
    """The present inputs of slow part k become a sample of its trace."""
    p = plan.slow.parts[k]
    first, count = plan.input_first[p], plan.input_first[p + 1] - plan.input_first[p]
    at = plan.slow.trace_first[k] + sample * count
    for i in range(count):
        plan.slow.trace[at + i] = values[plan.input_source[first + i]]


@inlined
def start_slow(plan: Plan, values: np.ndarray) -> None:
    """The run starts with these outputs."""
    for k in range(plan.slow.parts.size):
        for _ in range(plan.slow.past.shape[0]):
            _remember(plan.slow, k, values)
        _sample(plan, k, 0, values)


@inlined
def predict_slow(plan: Plan, history: np.ndarray, n: int, h: float) -> None:
    """Outputs of slow parts at the end of macro step n."""
    if n == 0:
        start_slow(plan, history[1])
    for i in range(plan.slow.output.size):
        history[0, plan.slow.output[i]] = slow_motion(plan.slow, i, n, 1.0, h)


@inlined
def predict_slow_nodes(plan: Plan, nodes: np.ndarray, start: np.ndarray, n: int, h: float) -> None:
    """Outputs of slow parts at the nodes of macro step n; the run starts with `start`."""
    if n == 0:
        start_slow(plan, start)
    degree = nodes.shape[0] - 1
    for node in range(1, degree + 1):
        for i in range(plan.slow.output.size):
            value = slow_motion(plan.slow, i, n, node / degree, h)
            nodes[node, plan.slow.output[i]] = value


@inlined
def trace_slow(plan: Plan, values: np.ndarray, n: int, node: int, per: int) -> None:
    """Collect the inputs of slow parts at node / per of macro step n."""
    for k in range(plan.slow.parts.size):
        _sample(plan, k, (n % plan.slow.multiple[k]) * per + node, values)


@inlined
def _set_fitted(plan: Plan, k: int) -> int:
    """Set the inputs of slow part k to the polynomial nearest to its trace; FMI status."""
    slow = plan.slow
    p = slow.parts[k]
    count = plan.input_first[p + 1] - plan.input_first[p]
    if count == 0:
        return 0
    samples = (slow.trace_first[k + 1] - slow.trace_first[k]) // count
    start = plan.set_first[p]
    for node in range(plan.degree[p] + 1):
        row = slow.fit_first[k] + node * samples
        for i in range(count):
            value = 0.0
            for s in range(samples):
                value += slow.fit[row + s] * slow.trace[slow.trace_first[k] + s * count + i]
            plan.set_value[start + node * count + i] = value
    total = count * (plan.degree[p] + 1)
    return exchange(plan, p, plan.set_real, plan.set_reference, start, total, plan.set_value, start)


@inlined
def finish_slow(plan: Plan, history: np.ndarray, chunk: Chunk, n: int) -> int:
    """Step the slow parts that macro step n brings to their communication point; -1, or who failed.

    All are recorded, if it is time for a row; those that wait as predicted.
    """
    slow, row = plan.slow, record_row(chunk, n)
    for k in range(slow.parts.size):
        p, multiple = slow.parts[k], slow.multiple[k]
        slow.waiting[p] = (n + 1) % multiple != 0
        if slow.waiting[p]:
            if row >= 0 and get_outputs(plan, history, p, chunk.records, row) > LAST_GOOD:
                return p
            continue
        t, h = chunk.t0 + (n + 1 - multiple) * chunk.h, multiple * chunk.h
        if _set_fitted(plan, k) > LAST_GOOD:
            return p
        slow.taken[p] += 1
        if do_step(plan.do_step[p], plan.component[p], t, h) > LAST_GOOD:
            return p
        if get_outputs(plan, history, p, chunk.records, row) > LAST_GOOD:
            return p
        _remember(slow, k, history[0])
        _sample(plan, k, 0, history[0])
    return -1

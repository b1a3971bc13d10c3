"""Compiled loop of `predict`: elements see predicted motions, then bodies step on their forces."""

from typing import NamedTuple

import numpy as np

from herringbone.cosim.energy.loop import book_step, is_watched
from herringbone.cosim.energy.monitor import EnergyMonitor
from herringbone.cosim.layouts.layout import Chunk, Layout
from herringbone.cosim.loops.calls import do_step
from herringbone.cosim.loops.common import (
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
    step_stage,
)
from herringbone.cosim.loops.derivatives import (
    derivative_order,
    sample,
    sample_count,
    set_derivatives,
    write_input,
)
from herringbone.kernels.compiling.jit import inlined, kernel

NODES = 3
"""Degree at which elements take motions and give forces."""
NO_RATE, FORCE = -1, -2
"""In `Prediction.rate`: of outputs whose rate is not known, and of the elements' forces."""


class Prediction(NamedTuple):
    """How motions are predicted, and where forces are read.

    Attributes:
        rate, second: for each output, the outputs that are its first and second time derivative;
            NO_RATE if there is none. The rate of an element's output is FORCE.
        elements, bodies: parts.
        sources: 1 if the layout's first stage holds the sources.
        node_first, node_reference: outputs of each element at its three nodes, node by node.
        forces: (4, outputs), values at c = 0, 1/3, 2/3, 1; row 0 is not used.
        values: room for one part's outputs at its nodes.
    """

    rate: np.ndarray
    second: np.ndarray
    elements: np.ndarray
    bodies: np.ndarray
    sources: int
    node_first: np.ndarray
    node_reference: np.ndarray
    forces: np.ndarray
    values: np.ndarray


@inlined
def predicted(
    prediction: Prediction, history: np.ndarray, index: int, known: int, c: float, h: float
) -> float:
    """Taylor value of an output at c in the macro step; extrapolated if it has no rate."""
    rate, second = prediction.rate[index], prediction.second[index]
    if rate < 0:
        return signal(history, index, 0, 2, known, c)
    value = history[1, index] + c * h * history[1, rate]
    if second >= 0:
        value += 0.5 * (c * h) ** 2 * history[1, second]
    return value


@inlined
def _step_element(
    layout: Layout,
    prediction: Prediction,
    history: np.ndarray,
    p: int,
    known: int,
    t: float,
    h: float,
) -> int:
    """Step an element on predicted motions, and read its forces at the nodes; FMI status."""
    first, end = layout.input_first[p], layout.input_first[p + 1]
    start = layout.set_first[p]
    at = start
    for node in range(NODES + 1):
        for i in range(first, end):
            source = layout.input_source[i]
            layout.set_value[at] = predicted(prediction, history, source, known, node / NODES, h)
            at += 1
    status = exchange(
        layout, p, layout.set_real, layout.set_reference, start, at - start, layout.set_value, start
    )
    if status > LAST_GOOD:
        return status
    status = do_step(layout.do_step[p], layout.component[p], t, h)
    if status > LAST_GOOD:
        return status
    begin, stop = prediction.node_first[p], prediction.node_first[p + 1]
    status = exchange(
        layout,
        p,
        layout.get_real,
        prediction.node_reference,
        begin,
        stop - begin,
        prediction.values,
        0,
    )
    k = 0
    for node in range(1, NODES + 1):
        for i in range(layout.output_first[p], layout.output_first[p + 1]):
            prediction.forces[node, i] = prediction.values[k]
            k += 1
    return status


@inlined
def _body_input(
    layout: Layout, prediction: Prediction, history: np.ndarray, i: int, known: int, c: float
) -> float:
    """Input i at c of the macro step: the quadratic through an element's three nodes."""
    source = layout.input_source[i]
    if prediction.rate[source] != FORCE:
        return signal(history, source, layout.input_fresh[i], 2, known, c)
    # Lagrange weights of the nodes 1/3, 2/3, 1
    w1 = 4.5 * (c - 2.0 / 3.0) * (c - 1.0)
    w2 = -9.0 * (c - 1.0 / 3.0) * (c - 1.0)
    w3 = 4.5 * (c - 1.0 / 3.0) * (c - 2.0 / 3.0)
    f = prediction.forces
    return w1 * f[1, source] + w2 * f[2, source] + w3 * f[3, source]


@inlined
def _set_body(
    layout: Layout, prediction: Prediction, history: np.ndarray, p: int, known: int, h: float
) -> int:
    """Set a body's inputs, at nodes or by derivatives if it has them; FMI status."""
    first, count = layout.input_first[p], layout.input_first[p + 1] - layout.input_first[p]
    start, degree, signals = layout.set_first[p], layout.degree[p], layout.derivatives
    samples = sample_count(signals) if derivative_order(signals, p) > 0 else 0
    for i in range(count):
        for node in range(degree + 1):
            c = node / degree if degree > 0 else 0.5
            layout.set_value[start + node * count + i] = _body_input(
                layout, prediction, history, first + i, known, c
            )
        for node in range(samples):
            c = node / (samples - 1)
            value = _body_input(layout, prediction, history, first + i, known, c)
            sample(signals, node, value)
        if samples > 0:
            write_input(signals, layout, p, i, h)
    status = exchange(
        layout, p, layout.set_real, layout.set_reference, start, (degree + 1) * count,
        layout.set_value, start,
    )  # fmt: skip
    return max(status, set_derivatives(signals, layout, p))


@inlined
def _step_parts(
    layout: Layout, prediction: Prediction, history: np.ndarray, known: int, t: float, h: float
) -> int:
    """Step elements on predicted motions, then bodies on their forces; -1, or who failed."""
    for p in prediction.elements:
        if _step_element(layout, prediction, history, p, known, t, h) > LAST_GOOD:
            return p
    for p in prediction.bodies:
        if _set_body(layout, prediction, history, p, known, h) > LAST_GOOD:
            return p
    for p in prediction.bodies:
        if do_step(layout.do_step[p], layout.component[p], t, h) > LAST_GOOD:
            return p
    return -1


@inlined
def _read_parts(
    layout: Layout, prediction: Prediction, history: np.ndarray, records: np.ndarray, row: int
) -> int:
    """Read the outputs of bodies and elements; -1, or who failed."""
    for group in (prediction.bodies, prediction.elements):
        for p in group:
            if get_outputs(layout, history, p, records, row) > LAST_GOOD:
                return p
    return -1


@inlined
def _slip(prediction: Prediction, history: np.ndarray, index: int, known: int, h: float) -> float:
    """Predicted output at the end of a step less the true one."""
    return predicted(prediction, history, index, known, 1.0, h) - history[0, index]


@kernel
def _watch(
    prediction: Prediction, monitor: EnergyMonitor, history: np.ndarray, known: int, h: float
) -> None:
    """Account for the energy of one macro step; arguments as of `energy.stages.watch_stages`."""
    forces, taken = prediction.forces, monitor.taken
    for i in range(monitor.places.force.size):
        f, s = monitor.places.force[i], monitor.places.position[i]
        start = 3.0 * (forces[1, f] - forces[2, f]) + forces[3, f]
        bend = 4.5 * (forces[1, f] - 2.0 * forces[2, f] + forces[3, f])
        rise = forces[3, f] - start - bend
        if monitor.places.held[i]:
            start, rise, bend = start + 0.5 * rise + 0.25 * bend, 0.0, 0.0
        taken[0, i], taken[1, i], taken[2, i] = start, rise, bend
        monitor.slip[0, i] = _slip(prediction, history, s, known, h) if s >= 0 else 0.0
        monitor.slip[1, i] = _slip(prediction, history, monitor.places.velocity[i], known, h)
    book_step(monitor, history, h)


@kernel
def run_predicted(
    layout: Layout, prediction: Prediction, history: np.ndarray, chunk: Chunk
) -> tuple[int, int, int]:
    """Run macro steps; arguments and result as of `loops.stages.run_stages`."""
    h = chunk.h
    for n in range(chunk.start, chunk.start + chunk.count):
        start_step(history)
        t, known, row = chunk.t0 + n * h, n + 1, record_row(chunk, n)
        failed = -1
        if prediction.sources:
            failed = step_stage(layout, history, 0, 2, known, t, h, chunk.records, row)
        if failed < 0:
            failed = _step_parts(layout, prediction, history, known, t, h)
        if failed < 0:
            failed = _read_parts(layout, prediction, history, chunk.records, row)
        if failed >= 0:
            return PART_FAILED, n, failed
        culprit = not_finite(layout, history)
        if culprit >= 0:
            return NOT_FINITE, n + 1, culprit
        if is_watched(chunk.energy, h):
            _watch(prediction, chunk.energy, history, known, h)
    return DONE, chunk.start + chunk.count, -1

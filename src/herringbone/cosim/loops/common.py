"""What every algorithm's compiled loop is made of: set, step, get, record.

Signals are polynomials through the values at communication points. With `order` q, a stale signal
(its source is stepped later in this macro step, or in parallel) is the polynomial through the last
q + 1 known values, extrapolated; a fresh one goes through its new value and the q values before,
interpolated.
"""

import numpy as np

from herringbone.cosim.layouts.layout import Chunk, Layout
from herringbone.cosim.layouts.slow import Slow
from herringbone.cosim.loops.calls import do_step, exchange_reals
from herringbone.cosim.loops.derivatives import (
    derivative_order,
    sample,
    sample_count,
    set_derivatives,
    write_input,
)
from herringbone.kernels.compiling.jit import inlined

DONE, PART_FAILED, NOT_FINITE, COUPLING_FAILED = 0, 1, 2, 4
"""Status of a chunk of macro steps."""
BOUND = 1e30
"""Signals beyond this, in SI units, have diverged."""
LAST_GOOD = 1
"""Largest FMI status after which a run goes on: fmi2Warning."""
DISCARDED = 2
"""FMI status of a part that takes no such step, but may take a shorter one: fmi2Discard."""
_REAL, _REFERENCE = 8, 4


@inlined
def signal(history: np.ndarray, index: int, fresh: int, order: int, known: int, c: float) -> float:
    """Value of a signal at c in [0, 1] of the macro step.

    Args:
        history: rows are the newest values (after a step) and those at the communication points
            before; row 1 is the start of the macro step.
        index: output.
        fresh: 1 if row 0 holds the value at the end of this macro step.
        order: degree of the polynomial.
        known: communication points passed, the start included.
        c: place in the macro step.
    """
    newest = 1 - fresh
    q = min(order, known - 1 + fresh)
    x = c - fresh
    value = history[newest, index]
    if q >= 1:
        first = value - history[newest + 1, index]
        value += x * first
        if q >= 2:
            before = history[newest + 1, index] - history[newest + 2, index]
            value += 0.5 * x * (x + 1.0) * (first - before)
    return value


@inlined
def exchange(
    layout: Layout, p: int, function: np.ndarray, references: np.ndarray, first: int, count: int,
    values: np.ndarray, at: int,
) -> int:  # fmt: skip
    """Set or get `count` reals of a part: references from `first`, values from `at` (flat)."""
    return exchange_reals(
        function[p],
        layout.component[p],
        references.ctypes.data + _REFERENCE * first,
        count,
        values.ctypes.data + _REAL * at,
    )


@inlined
def start_step(history: np.ndarray) -> None:
    """Row 0 of the history becomes row 1, and so on: a macro step begins."""
    for row in range(history.shape[0] - 1, 0, -1):
        for i in range(history.shape[1]):
            history[row, i] = history[row - 1, i]


@inlined
def record_row(chunk: Chunk, n: int) -> int:
    """Row of the records that macro step n fills, or -1."""
    return (n + 1) // chunk.every - chunk.first_row if (n + 1) % chunk.every == 0 else -1


@inlined
def _set_polynomials(
    layout: Layout, history: np.ndarray, p: int, order: int, known: int, h: float
) -> int:
    """Set all connected inputs of a part by value and derivatives; FMI status."""
    signals, first = layout.derivatives, layout.input_first[p]
    samples = sample_count(signals)
    count, at = layout.input_first[p + 1] - first, layout.set_first[p]
    for i in range(count):
        source, fresh = layout.input_source[first + i], layout.input_fresh[first + i]
        for node in range(samples):
            c = node / (samples - 1)
            sample(signals, node, signal(history, source, fresh, order, known, c))
        write_input(signals, layout, p, i, h)
    status = exchange(
        layout, p, layout.set_real, layout.set_reference, at, count, layout.set_value, at
    )
    return max(status, set_derivatives(signals, layout, p))


@inlined
def set_inputs(
    layout: Layout, history: np.ndarray, p: int, order: int, known: int, h: float
) -> int:
    """Set all connected inputs of a part, at nodes or by derivatives if it has them; FMI status."""
    first, end = layout.input_first[p], layout.input_first[p + 1]
    if first == end:
        return 0
    if derivative_order(layout.derivatives, p) > 0:
        return _set_polynomials(layout, history, p, order, known, h)
    at, degree = layout.set_first[p], layout.degree[p]
    for node in range(degree + 1):
        c = node / degree if degree > 0 else 0.0
        for i in range(first, end):
            fresh = layout.input_fresh[i]
            # A held input of an element, or of a body whose source is known, is its newest value.
            place = 1.0 if layout.at_end[p] or (degree == 0 and fresh) else c
            layout.set_value[at] = signal(
                history, layout.input_source[i], fresh, order, known, place
            )
            at += 1
    start = layout.set_first[p]
    return exchange(
        layout, p, layout.set_real, layout.set_reference, start, at - start, layout.set_value, start
    )


@inlined
def is_slow(slow: Slow | None, p: int) -> bool:
    """True if a part steps once in several macro steps."""
    if slow is None:
        return False
    return slow.taken[p] >= 0


@inlined
def is_waiting(slow: Slow | None, p: int) -> bool:
    """True if a part has not reached the present communication point."""
    if slow is None:
        return False
    return slow.waiting[p] != 0


@inlined
def get_outputs(layout: Layout, history: np.ndarray, p: int, records: np.ndarray, row: int) -> int:
    """Get all connected outputs of a part into row 0 of the history; FMI status.

    With row >= 0 all recorded outputs are read into that row of the records, and the connected
    ones, which are among them, are copied: one call to the part in both cases.
    """
    first, end = layout.output_first[p], layout.output_first[p + 1]
    if row < 0:
        if first == end:
            return 0
        return exchange(
            layout, p, layout.get_real, layout.output_reference, first, end - first, history, first
        )
    at, count = layout.record_first[p], layout.record_first[p + 1] - layout.record_first[p]
    status = 0
    if count > 0:
        place = row * records.shape[1] + at
        status = exchange(
            layout, p, layout.get_real, layout.record_reference, at, count, records, place
        )
    for i in range(first, end):
        if is_waiting(layout.slow, p):  # its connected outputs are predicted meanwhile
            records[row, layout.output_record[i]] = history[0, i]
        else:
            history[0, i] = records[row, layout.output_record[i]]
    return status


@inlined
def get_all(layout: Layout, history: np.ndarray, records: np.ndarray, row: int) -> int:
    """Get the outputs of all parts, recorded in a row; -1, or the first part that refuses some.

    Of such a part connected outputs are read alone, and all others are NaN in the row.
    """
    refused = -1
    for p in range(layout.component.size):
        if get_outputs(layout, history, p, records, row) <= LAST_GOOD:
            continue
        refused = p if refused < 0 else refused
        records[row, layout.record_first[p] : layout.record_first[p + 1]] = np.nan
        known = get_outputs(layout, history, p, records, -1) <= LAST_GOOD
        for i in range(layout.output_first[p], layout.output_first[p + 1]):
            if not known:
                history[0, i] = np.nan
            records[row, layout.output_record[i]] = history[0, i]
    return refused


@inlined
def step_stage(
    layout: Layout,
    history: np.ndarray,
    stage: int,
    order: int,
    known: int,
    t: float,
    h: float,
    records: np.ndarray,
    row: int,
) -> int:
    """Step the parts of one stage over the macro step; -1, or the part that failed."""
    first, end = layout.stage_first[stage], layout.stage_first[stage + 1]
    for k in range(first, end):
        if set_inputs(layout, history, layout.stage_part[k], order, known, h) > LAST_GOOD:
            return layout.stage_part[k]
    for k in range(first, end):
        p = layout.stage_part[k]
        if do_step(layout.do_step[p], layout.component[p], t, h) > LAST_GOOD:
            return p
    for k in range(first, end):
        if get_outputs(layout, history, layout.stage_part[k], records, row) > LAST_GOOD:
            return layout.stage_part[k]
    return -1


@inlined
def not_finite(layout: Layout, history: np.ndarray) -> int:
    """Part whose newest outputs are NaN, infinite or beyond BOUND, or -1."""
    for p in range(layout.component.size):
        for i in range(layout.output_first[p], layout.output_first[p + 1]):
            if not abs(history[0, i]) < BOUND:
                return p
    return -1

"""Outputs of a condensed core with open inputs, when they are read, compiled."""

import numpy as np

from herringbone.analysis.twin.condensed.recorded.observing import show
from herringbone.analysis.twin.core_part.memory import PLACES, readers
from herringbone.analysis.twin.core_part.stepping import (
    ANSWERED,
    ASK,
    BASE_STEP,
    DEGREE,
    DISCARD,
    ENDS_KNOWN,
    FOR_ROWS,
    INNER_KNOWN,
    OK,
    REST_KNOWN,
    RUNGS,
    TIME,
    ask,
)
from herringbone.kernels.compiling.jit import finding
from herringbone.kernels.condensed.modal import add_product, copy
from herringbone.kernels.signals import STRIDE

_FIXED, _STATE, _SAMPLES = PLACES["fixed"], PLACES["state"], PLACES["samples"]
_SENT, _OTHERS, _SIGNALS = PLACES["sent"], PLACES["others"], PLACES["signals"]
_fixed_at, _state_at, _samples_at = readers.fixed_at, readers.state_at, readers.samples_at
_shown_at, _signals_at = readers.shown_at, readers.signals_at


@finding
def _rows_at_end(m: np.ndarray, still: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """Rows at the end of the last step; good until the next call."""
    signals, state, fixed = _signals_at(m, _SIGNALS), _state_at(m, _STATE), _fixed_at(m, _FIXED)
    nodes, size = fixed.nodes.size, state.q.size
    rows, ends = signals.rows[: still.size], signals.ends
    for k in range(ends.size):
        ends[k] = state.u[k * nodes + nodes - 1]
    copy(still, rows)
    add_product(matrix[:size], state.q, rows)
    add_product(matrix[size:], ends, rows)
    return rows


@finding
def know_ends(m: np.ndarray) -> None:
    """Find the sent outputs at the end of the last step."""
    signals, sent = _signals_at(m, _SIGNALS), _shown_at(m, _SENT)
    if signals.flags[ENDS_KNOWN] != 0:
        return
    found = signals.found
    show(sent, signals.clock[TIME], _rows_at_end(m, sent.still, signals.end), found)
    degree = signals.flags[DEGREE]
    for j in range(found.size):
        signals.values[j * STRIDE] = signals.values[j * STRIDE + degree] = found[j]
    signals.flags[ENDS_KNOWN] = 1


@finding
def _know_inner(m: np.ndarray) -> int:
    """Find the sent outputs at the nodes inside of the last step; FMI status."""
    signals, samples = _signals_at(m, _SIGNALS), _samples_at(m, _SAMPLES)
    flags, degree = signals.flags, signals.flags[DEGREE]
    if flags[INNER_KNOWN] != 0:
        return OK
    sent, found = _shown_at(m, _SENT), signals.found
    rows = signals.rows[: sent.still.size]
    for k in range(1, degree):
        rung = int(np.rint(np.log2(signals.clock[BASE_STEP] / samples.length[k - 1])))
        wanted = float(RUNGS * (k - 1) + rung)
        if signals.made[k - 1, rung] == 0 and ask(flags[ASK], (FOR_ROWS, wanted)) != ANSWERED:
            return DISCARD
        copy(sent.still, rows)
        add_product(signals.inner[k - 1, rung], samples.held[k - 1], rows)
        show(sent, samples.times[k - 1], rows, found)
        for j in range(found.size):
            signals.values[j * STRIDE + k] = found[j]
    flags[INNER_KNOWN] = 1
    return OK


@finding
def _know_rest(m: np.ndarray) -> None:
    """Find the other outputs at the end of the last step."""
    signals, others = _signals_at(m, _SIGNALS), _shown_at(m, _OTHERS)
    if signals.flags[REST_KNOWN] == 0:
        rows = _rows_at_end(m, others.still, signals.rest_end)
        show(others, signals.clock[TIME], rows, signals.rest)
        signals.flags[REST_KNOWN] = 1


@finding
def read(m: np.ndarray, references: np.ndarray, count: int, values: np.ndarray) -> int:
    """Write values of inputs and outputs by their references; FMI status."""
    signals = _signals_at(m, _SIGNALS)
    inputs, sent = signals.given.size, signals.given.size + signals.values.size
    degree = signals.flags[DEGREE]
    for i in range(count):
        reference = references[i]
        if reference < inputs:
            values[i] = signals.given[reference]
        elif reference < sent:
            node = reference % STRIDE
            if 0 < node < degree:
                if _know_inner(m) != OK:
                    return DISCARD
            else:
                know_ends(m)
            values[i] = signals.values[reference - inputs]
        else:
            _know_rest(m)
            values[i] = signals.rest[(reference - sent) // STRIDE]
    return OK

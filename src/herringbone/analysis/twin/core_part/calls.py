"""FMI 2.0 functions of a condensed core with open inputs, at C addresses.

Inputs and outputs are polynomial signals over a macro step, by their values at nodes. A step makes
the inputs channels of the core and marches over it; outputs are found when they are read. The
component pointer is the address of a `memory`. References: input i at node k is i STRIDE + k; sent
output j at node k (n + j) STRIDE + k, node 0 being the end; other output j (n + m + j) STRIDE.

What needs matrices of a length that is not known yet asks a function of Python for them.
"""

import numpy as np
from numba import carray, types

from herringbone.analysis.twin.condensed.march import LAST
from herringbone.analysis.twin.core_part.answers import know_ends, read
from herringbone.analysis.twin.core_part.memory import PLACES, readers
from herringbone.analysis.twin.core_part.stepping import (
    ENDS_KNOWN,
    INNER_KNOWN,
    LAST_LENGTH,
    OK,
    REST_KNOWN,
    TIME,
    advance,
)
from herringbone.kernels.compiling.jit import UNKNOWN_SIZE, c_function, finding, reals_at

_TABLE, _NODES = PLACES["table"], PLACES["nodes"]
_STATE, _SIGNALS = PLACES["state"], PLACES["signals"]
_table_at, _nodes_at = readers.table_at, readers.nodes_at
_state_at, _signals_at = readers.state_at, readers.signals_at

_MEMORY = types.CPointer(types.int64)
_REALS = types.CPointer(types.float64)
_EXCHANGE = types.int32(_MEMORY, types.CPointer(types.uint32), types.size_t, _REALS)
_DO_STEP = types.int32(_MEMORY, types.float64, types.float64, types.int32)
_SAVE = types.int32(_MEMORY, types.CPointer(types.int64))
_RESTORE = types.int32(_MEMORY, _REALS)


@finding
def save(m: np.ndarray, saved: np.ndarray) -> int:
    """Write all that a step changes; returns how many reals."""
    know_ends(m)
    signals, state, nodes = _signals_at(m, _SIGNALS), _state_at(m, _STATE), _nodes_at(m, _NODES)
    saved[0], saved[1], saved[2] = (
        signals.clock[TIME],
        signals.clock[LAST_LENGTH],
        state.place[LAST],
    )
    at = 3
    scale = _table_at(m, _TABLE).scale
    for array in (state.q, state.u, nodes.start, nodes.e[0], scale, signals.last, signals.values):
        for i in range(array.size):  # the length of what is saved is not known
            saved[at + i] = array[i]
        at += array.size
    return at


@finding
def restore(m: np.ndarray, saved: np.ndarray) -> None:
    """Take back what `save` wrote."""
    signals, state, nodes = _signals_at(m, _SIGNALS), _state_at(m, _STATE), _nodes_at(m, _NODES)
    signals.clock[TIME], signals.clock[LAST_LENGTH] = saved[0], saved[1]
    state.place[LAST] = int(saved[2])
    at = 3
    scale = _table_at(m, _TABLE).scale
    for array in (state.q, state.u, nodes.start, nodes.e[0], scale, signals.last, signals.values):
        for i in range(array.size):
            array[i] = saved[at + i]
        at += array.size
    flags = signals.flags
    flags[ENDS_KNOWN], flags[INNER_KNOWN], flags[REST_KNOWN] = 1, 1, 0


@c_function(_EXCHANGE)
def set_real(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """fmi2SetReal, of inputs at nodes."""
    signals = _signals_at(carray(memory, UNKNOWN_SIZE), _SIGNALS)
    reference, value = carray(references, UNKNOWN_SIZE), carray(values, UNKNOWN_SIZE)
    for i in range(count):
        signals.given[reference[i]] = value[i]
    return types.int32(OK)


@c_function(_EXCHANGE)
def get_real(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """fmi2GetReal, of outputs at nodes."""
    reference, value = carray(references, UNKNOWN_SIZE), carray(values, UNKNOWN_SIZE)
    return types.int32(read(carray(memory, UNKNOWN_SIZE), reference, count, value))


@c_function(_DO_STEP)
def do_step(memory, time, step, no_set_before):  # noqa: ANN001, ANN201 (typed by _DO_STEP)
    """fmi2DoStep."""
    return types.int32(advance(carray(memory, UNKNOWN_SIZE), time, step))


@c_function(_SAVE)
def get_state(memory, handle):  # noqa: ANN001, ANN201 (typed by _SAVE)
    """fmi2GetFMUstate, into the memory that the handle already names."""
    save(carray(memory, UNKNOWN_SIZE), carray(reals_at(handle, 0), UNKNOWN_SIZE))
    return types.int32(OK)


@c_function(_RESTORE)
def set_state(memory, saved):  # noqa: ANN001, ANN201 (typed by _RESTORE)
    """fmi2SetFMUstate."""
    restore(carray(memory, UNKNOWN_SIZE), carray(saved, UNKNOWN_SIZE))
    return types.int32(OK)


@c_function(_SAVE)
def free_state(memory, handle):  # noqa: ANN001, ANN201 (typed by _SAVE)
    """fmi2FreeFMUstate; the memory belongs to the part."""
    return types.int32(OK)

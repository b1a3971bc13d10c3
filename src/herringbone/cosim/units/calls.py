"""FMI 2.0 functions in front of those of a part, at C addresses, with values in SI base units.

A value in SI units is factor * own + offset; time derivatives have the factor only. The component
pointer is the address of the part's memory, a record of type `MEMORY`. References of this interface
are places in the table of variables.
"""

import numpy as np
from numba import carray, from_dtype, types

from herringbone.core.declaring.variable import NODES
from herringbone.cosim.loops.calls import (
    at_address,
    exchange_derivatives,
    exchange_reals,
    state_call,
)
from herringbone.cosim.loops.calls import do_step as step_part
from herringbone.cosim.loops.common import LAST_GOOD
from herringbone.kernels.compiling.jit import UNKNOWN_SIZE, allocating, c_function

MEMORY = np.dtype(
    [
        (name, np.int64)
        for name in (
            "component",
            "set_real",
            "get_real",
            "do_step",
            "get_state",
            "set_state",
            "free_state",
            "set_derivatives",
            "get_derivatives",
            "count",
            "references",
            "factor",
            "offset",
            "room",
            "called",
            "values",
        )
    ]
)
"""What an adapter knows.

component, and the addresses of the part's functions; count of variables; addresses of their
references (uint32), factors and offsets (float64); how many values a call may have, which are up to
ORDERS of each input, and addresses of the references (uint32) and values (float64) of the current
call.
"""
ORDERS = NODES
"""Highest order of input derivatives: polynomials over a step have no higher degree."""

_ERROR = 3
_MEMORY = types.CPointer(from_dtype(MEMORY))
_EXCHANGE = types.int32(
    _MEMORY, types.CPointer(types.uint32), types.size_t, types.CPointer(types.float64)
)
_STEP = types.int32(_MEMORY, types.float64, types.float64, types.int32)
_STATE = types.int32(_MEMORY, types.int64)
_DERIVATIVES = types.int32(
    _MEMORY,
    types.CPointer(types.uint32),
    types.size_t,
    types.int64,
    types.CPointer(types.float64),
)


@allocating
def _call(memory: np.ndarray, references: np.ndarray, count: int) -> bool:
    """References of the part for those of this interface; False if there is no room for them."""
    part = memory[0]
    if count > part.room:
        return False
    own = carray(at_address(part.references), part.count, np.uint32)
    called = carray(at_address(part.called), part.room, np.uint32)
    for i in range(count):
        called[i] = own[references[i]]
    return True


@allocating
def _to_own(
    memory: np.ndarray, references: np.ndarray, count: int, values: np.ndarray, shift: float
) -> None:
    """Values in the part's units, for the current call; `shift`: 0 without the offset."""
    part = memory[0]
    factor = carray(at_address(part.factor), part.count, np.float64)
    offset = carray(at_address(part.offset), part.count, np.float64)
    own = carray(at_address(part.values), part.room, np.float64)
    for i in range(count):
        k = references[i]
        own[i] = values[i]
        if factor[k] != 1.0 or offset[k] != 0.0:
            own[i] = (values[i] - shift * offset[k]) / factor[k]


@allocating
def _to_si(
    memory: np.ndarray, references: np.ndarray, count: int, values: np.ndarray, shift: float
) -> None:
    """Values in SI units, in place."""
    part = memory[0]
    factor = carray(at_address(part.factor), part.count, np.float64)
    offset = carray(at_address(part.offset), part.count, np.float64)
    for i in range(count):
        k = references[i]
        if factor[k] != 1.0 or offset[k] != 0.0:
            values[i] = values[i] * factor[k] + shift * offset[k]


@c_function(_EXCHANGE)
def set_real(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """fmi2SetReal."""
    whole, reference = carray(memory, 1), carray(references, UNKNOWN_SIZE)
    part = whole[0]
    if not _call(whole, reference, count):
        return types.int32(_ERROR)
    _to_own(whole, reference, count, carray(values, UNKNOWN_SIZE), 1.0)
    return types.int32(
        exchange_reals(part.set_real, part.component, part.called, count, part.values)
    )


@c_function(_EXCHANGE)
def get_real(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """fmi2GetReal."""
    whole, reference = carray(memory, 1), carray(references, UNKNOWN_SIZE)
    part, found = whole[0], carray(values, UNKNOWN_SIZE)
    if not _call(whole, reference, count):
        return types.int32(_ERROR)
    status = exchange_reals(part.get_real, part.component, part.called, count, found.ctypes.data)
    if status <= LAST_GOOD:
        _to_si(whole, reference, count, found, 1.0)
    return types.int32(status)


@c_function(_DERIVATIVES)
def set_derivatives(memory, references, count, orders, values):  # noqa: ANN001, ANN201
    """fmi2SetRealInputDerivatives."""
    whole, reference = carray(memory, 1), carray(references, UNKNOWN_SIZE)
    part = whole[0]
    if not _call(whole, reference, count):
        return types.int32(_ERROR)
    _to_own(whole, reference, count, carray(values, UNKNOWN_SIZE), 0.0)
    return types.int32(
        exchange_derivatives(
            part.set_derivatives, part.component, part.called, count, orders, part.values
        )
    )


@c_function(_DERIVATIVES)
def get_derivatives(memory, references, count, orders, values):  # noqa: ANN001, ANN201
    """fmi2GetRealOutputDerivatives."""
    whole, reference = carray(memory, 1), carray(references, UNKNOWN_SIZE)
    part, found = whole[0], carray(values, UNKNOWN_SIZE)
    if not _call(whole, reference, count):
        return types.int32(_ERROR)
    status = exchange_derivatives(
        part.get_derivatives, part.component, part.called, count, orders, found.ctypes.data
    )
    if status <= LAST_GOOD:
        _to_si(whole, reference, count, found, 0.0)
    return types.int32(status)


@c_function(_STEP)
def do_step(memory, time, step, no_set_before):  # noqa: ANN001, ANN201 (typed by _STEP)
    """fmi2DoStep."""
    part = carray(memory, 1)[0]
    return types.int32(step_part(part.do_step, part.component, time, step))


@c_function(_STATE)
def get_state(memory, handle):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2GetFMUstate."""
    part = carray(memory, 1)[0]
    return state_call(part.get_state, part.component, handle)


@c_function(_STATE)
def set_state(memory, state):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2SetFMUstate."""
    part = carray(memory, 1)[0]
    return state_call(part.set_state, part.component, state)


@c_function(_STATE)
def free_state(memory, handle):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2FreeFMUstate."""
    part = carray(memory, 1)[0]
    return state_call(part.free_state, part.component, handle)

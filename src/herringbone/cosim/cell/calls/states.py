"""FMI 2.0 functions of states in front of those of a part in a cell; see `signals`."""

import numpy as np
from numba import carray, types

from herringbone.cosim.cell.block import FREE, RESTORE, SAVE, STATES
from herringbone.cosim.cell.calls.messages import ERROR, LAST_GOOD, room
from herringbone.cosim.cell.calls.operations import begin, collected
from herringbone.cosim.cell.calls.signals import INSTANCE_POINTER
from herringbone.cosim.loops.calls import at_address
from herringbone.kernels.compiling.jit import c_function

_HANDLE = types.int32(INSTANCE_POINTER, types.CPointer(types.int64))
_STATE = types.int32(INSTANCE_POINTER, types.int64)


@c_function(_HANDLE)
def get_state(memory, handle):  # noqa: ANN001, ANN201 (typed by _HANDLE)
    """fmi2GetFMUstate; a handle is the number of the state, from 1."""
    whole, given = carray(memory, 1), carray(handle, 1)
    status = room(whole, 0)
    if status > LAST_GOOD:
        return types.int32(status)
    part = whole[0]
    slot = carray(at_address(part.slots), STATES, np.uint8)
    number = given[0]
    if number == 0:
        number = 1
        while number < STATES and slot[number]:
            number += 1
        if number == STATES:
            return types.int32(ERROR)
    part.used = begin(whole, SAVE, number)
    slot[number] = 1
    found = part.valid, part.rate_valid
    status = collected(whole, SAVE)
    if status <= LAST_GOOD:
        given[0] = number
        part.valid, part.rate_valid = found  # saving changes nothing
    return types.int32(status)


@c_function(_STATE)
def set_state(memory, state):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2SetFMUstate."""
    whole = carray(memory, 1)
    status = room(whole, 0)
    if status > LAST_GOOD:
        return types.int32(status)
    part = whole[0]
    part.used = begin(whole, RESTORE, state)
    return types.int32(collected(whole, RESTORE))


@c_function(_HANDLE)
def free_state(memory, handle):  # noqa: ANN001, ANN201 (typed by _HANDLE)
    """fmi2FreeFMUstate."""
    whole, given = carray(memory, 1), carray(handle, 1)
    status = room(whole, 0)
    if status > LAST_GOOD or given[0] == 0:
        return types.int32(status)
    part = whole[0]
    part.used = begin(whole, FREE, given[0])
    slot = carray(at_address(part.slots), STATES, np.uint8)
    slot[given[0]], given[0] = 0, 0
    found = part.valid, part.rate_valid
    status = collected(whole, FREE)
    part.valid, part.rate_valid = found
    return types.int32(status)

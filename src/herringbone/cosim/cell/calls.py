"""FMI 2.0 functions in front of those of a part in a cell, at C addresses.

The component pointer is the address of the instance's memory, a record of type `block.INSTANCE`.
"""

import numpy as np
from numba import carray, from_dtype, types

from herringbone.cosim.cell.atomics import load_acquire
from herringbone.cosim.cell.block import (
    ALIVE,
    ANSWER,
    CELL_SLEEPS,
    FREE,
    GET,
    GET_DERIVATIVES,
    HEADER,
    HEADER_TYPE,
    INSTANCE,
    KINDS,
    MASTER_SLEEPS,
    OPERATIONS,
    REQUEST,
    RESTORE,
    SAVE,
    SET,
    SET_DERIVATIVES,
    SIDE,
    STATES,
    STEP,
)
from herringbone.cosim.cell.waiting import await_word, post
from herringbone.cosim.loops.calls import at_address
from herringbone.kernels.jit import allocating, c_function

_SIDE = types.CPointer(from_dtype(SIDE))
_INSTANCE = types.CPointer(from_dtype(INSTANCE))
_EXCHANGE = types.int32(
    _INSTANCE, types.CPointer(types.uint32), types.size_t, types.CPointer(types.float64)
)
_DERIVATIVES = types.int32(
    _INSTANCE,
    types.CPointer(types.uint32),
    types.size_t,
    types.CPointer(types.int32),
    types.CPointer(types.float64),
)
_STEP = types.int32(_INSTANCE, types.float64, types.float64, types.int32)
_HANDLE = types.int32(_INSTANCE, types.CPointer(types.int64))
_STATE = types.int32(_INSTANCE, types.int64)
_UNKNOWN_SIZE = 1  # bounds are not checked
_LAST_GOOD, _ERROR, _FATAL = 1, 3, 4


@allocating
def _converse(side: np.ndarray) -> int:
    """Post what stands in the block, and wait for the answer; why there is none."""
    block = side[0].block
    number = (load_acquire(block + REQUEST) + 1) & 0x3FFFFFFF
    post(side, block + REQUEST, number, block + CELL_SLEEPS)
    found = await_word(side, block + ANSWER, number, block + MASTER_SLEEPS)
    if found != ALIVE:
        side[0].lost = found
    return found


@c_function(types.int32(_SIDE))
def converse(memory):  # noqa: ANN001, ANN201
    """Exchange the message that stands in the block; 0, or why there is no answer."""
    return types.int32(_converse(carray(memory, 1)))


@allocating
def _send(memory: np.ndarray) -> int:
    """Send all operations that were collected; worst FMI status. The answer stays in the block."""
    part = memory[0]
    side = carray(at_address(part.side), 1, SIDE)
    if side[0].lost != ALIVE:
        memory[0].used = memory[0].waiting = 0
        return _FATAL
    own = carray(at_address(part.words), part.used, np.int64)
    words = carray(at_address(side[0].words), part.used, np.int64)
    for i in range(part.used):
        words[i] = own[i]
    header = carray(at_address(side[0].block + HEADER), 1, HEADER_TYPE)
    header[0].kind, header[0].instance = OPERATIONS, part.number
    header[0].words, header[0].status = part.used, 0
    memory[0].used = memory[0].waiting = 0
    if _converse(side) != ALIVE:
        return _FATAL
    return header[0].status


@allocating
def _room(memory: np.ndarray, words: int) -> int:
    """Make room for an operation; FMI status."""
    part = memory[0]
    side = carray(at_address(part.side), 1, SIDE)
    if part.used + words + 4 > side[0].capacity:
        if words + 4 > side[0].capacity:
            return _ERROR
        return _send(memory)
    return 0


@allocating
def _begin(memory: np.ndarray, kind: int, count: int) -> int:
    """Begin an operation: where its content goes, in words."""
    part = memory[0]
    words = carray(at_address(part.words), part.used + 2, np.int64)
    words[part.used], words[part.used + 1] = kind, count
    return part.used + 2


@allocating
def _collected(memory: np.ndarray, kind: int) -> int:
    """An operation is complete: it waits, or is sent if it is the first of its kind. FMI status."""
    part = memory[0]
    part.valid = part.rate_valid = 0
    known = carray(at_address(part.known), KINDS, np.uint8)
    if known[kind]:
        return 0
    status = _send(memory)
    if status <= _LAST_GOOD:
        known[kind] = 1
    return status


@allocating
def _ask(memory: np.ndarray) -> None:
    """Collect the request for the outputs that were read last."""
    part = memory[0]
    at = _begin(memory, GET, part.count)
    words = carray(at_address(part.words), at + part.count, np.int64)
    reference = carray(at_address(part.references), part.count, np.uint32)
    for i in range(part.count):
        words[at + i] = reference[i]
    part.used = at + part.count


@allocating
def _ask_rates(memory: np.ndarray) -> None:
    """Collect the request for the derivatives that were read last."""
    part = memory[0]
    count = part.rate_count
    at = _begin(memory, GET_DERIVATIVES, count)
    words = carray(at_address(part.words), at + 2 * count, np.int64)
    reference = carray(at_address(part.rates), count, np.uint32)
    order = carray(at_address(part.orders), count, np.int32)
    for i in range(count):
        words[at + i], words[at + count + i] = reference[i], order[i]
    part.used = at + 2 * count


@allocating
def _keep(memory: np.ndarray, rates: bool) -> None:
    """Keep the outputs of an answer; with `rates`, their derivatives after them."""
    part = memory[0]
    side = carray(at_address(part.side), 1, SIDE)
    header = carray(at_address(side[0].block + HEADER), 1, HEADER_TYPE)
    value = carray(at_address(side[0].values), part.count + part.rate_count + 2, np.float64)
    found = carray(at_address(part.found), part.count, np.float64)
    part.status, at = int(value[0]), 1
    for i in range(part.count):
        found[i] = value[at + i]
    part.valid = 1
    at += part.count
    if rates and header[0].values > at:
        rate = carray(at_address(part.rate_found), part.rate_count, np.float64)
        part.rate_status, part.rate_valid = int(value[at]), 1
        for i in range(part.rate_count):
            rate[i] = value[at + 1 + i]


@allocating
def _step_now(memory: np.ndarray) -> int:
    """Send the steps that were collected, with the requests for outputs; FMI status."""
    part = memory[0]
    _ask(memory)
    if part.rate_count > 0:
        _ask_rates(memory)
    status = _send(memory)
    if status <= _LAST_GOOD:
        carray(at_address(part.known), KINDS, np.uint8)[STEP] = 1
        _keep(memory, True)
    return status


@c_function(_EXCHANGE)
def set_real(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """fmi2SetReal."""
    whole, reference = carray(memory, 1), carray(references, _UNKNOWN_SIZE)
    value, number = carray(values, _UNKNOWN_SIZE), int(count)
    status = _room(whole, 2 * number)
    if status > _LAST_GOOD:
        return types.int32(status)
    part = whole[0]
    at = _begin(whole, SET, number)
    words = carray(at_address(part.words), at + 2 * number, np.int64)
    reals = carray(at_address(part.words), at + 2 * number, np.float64)
    for i in range(number):
        words[at + i], reals[at + number + i] = reference[i], value[i]
    part.used = at + 2 * number
    return types.int32(_collected(whole, SET))


@allocating
def _same(memory: np.ndarray, references: np.ndarray, count: int) -> bool:
    """True if these are the outputs that were read last."""
    part = memory[0]
    if part.count != count:
        return False
    kept = carray(at_address(part.references), part.count, np.uint32)
    for i in range(count):
        if kept[i] != references[i]:
            return False
    return True


@c_function(_EXCHANGE)
def get_real(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """fmi2GetReal: what came with the last step, or a message of its own."""
    whole, reference = carray(memory, 1), carray(references, _UNKNOWN_SIZE)
    value, number = carray(values, _UNKNOWN_SIZE), int(count)
    part = whole[0]
    part.read = 1
    if part.waiting and _same(whole, reference, number):
        status = _step_now(whole)
        if status > _LAST_GOOD:
            return types.int32(status)
    if not (part.valid and _same(whole, reference, number)):
        status = _room(whole, number)
        if status > _LAST_GOOD:
            return types.int32(status)
        kept = carray(at_address(part.references), number, np.uint32)
        for i in range(number):
            kept[i] = reference[i]
        part.count, part.valid = number, 0
        _ask(whole)
        status = _send(whole)
        if status > _LAST_GOOD:
            return types.int32(status)
        _keep(whole, False)
    if part.status <= _LAST_GOOD:
        found = carray(at_address(part.found), number, np.float64)
        for i in range(number):
            value[i] = found[i]
    return types.int32(part.status)


@c_function(_STEP)
def do_step(memory, time, step, no_set_before):  # noqa: ANN001, ANN201 (typed by _STEP)
    """fmi2DoStep: where outputs were read after the last one, it waits for that, or the next step.

    A step that fails says so there; the first one is made at once.
    """
    whole = carray(memory, 1)
    part = whole[0]
    status = _room(whole, 4 + part.count + 2 * part.rate_count)
    if status > _LAST_GOOD:
        return types.int32(status)
    at = _begin(whole, STEP, 2)
    reals = carray(at_address(part.words), at + 2, np.float64)
    reals[at], reals[at + 1] = time, step
    part.used, part.valid, part.rate_valid = at + 2, 0, 0
    part.waiting += 1
    read, part.read = part.read, 0
    if part.waiting == 1 and read and carray(at_address(part.known), KINDS, np.uint8)[STEP]:
        return types.int32(0)
    return types.int32(_step_now(whole))


@c_function(_HANDLE)
def get_state(memory, handle):  # noqa: ANN001, ANN201 (typed by _HANDLE)
    """fmi2GetFMUstate; a handle is the number of the state, from 1."""
    whole, given = carray(memory, 1), carray(handle, 1)
    status = _room(whole, 0)
    if status > _LAST_GOOD:
        return types.int32(status)
    part = whole[0]
    slot = carray(at_address(part.slots), STATES, np.uint8)
    number = given[0]
    if number == 0:
        number = 1
        while number < STATES and slot[number]:
            number += 1
        if number == STATES:
            return types.int32(_ERROR)
    part.used = _begin(whole, SAVE, number)
    slot[number] = 1
    found = part.valid, part.rate_valid
    status = _collected(whole, SAVE)
    if status <= _LAST_GOOD:
        given[0] = number
        part.valid, part.rate_valid = found  # saving changes nothing
    return types.int32(status)


@c_function(_STATE)
def set_state(memory, state):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2SetFMUstate."""
    whole = carray(memory, 1)
    status = _room(whole, 0)
    if status > _LAST_GOOD:
        return types.int32(status)
    part = whole[0]
    part.used = _begin(whole, RESTORE, state)
    return types.int32(_collected(whole, RESTORE))


@c_function(_HANDLE)
def free_state(memory, handle):  # noqa: ANN001, ANN201 (typed by _HANDLE)
    """fmi2FreeFMUstate."""
    whole, given = carray(memory, 1), carray(handle, 1)
    status = _room(whole, 0)
    if status > _LAST_GOOD or given[0] == 0:
        return types.int32(status)
    part = whole[0]
    part.used = _begin(whole, FREE, given[0])
    slot = carray(at_address(part.slots), STATES, np.uint8)
    slot[given[0]], given[0] = 0, 0
    found = part.valid, part.rate_valid
    status = _collected(whole, FREE)
    part.valid, part.rate_valid = found
    return types.int32(status)


@c_function(_DERIVATIVES)
def set_derivatives(memory, references, count, orders, values):  # noqa: ANN001, ANN201
    """fmi2SetRealInputDerivatives; sent at once until an order is accepted."""
    whole, reference = carray(memory, 1), carray(references, _UNKNOWN_SIZE)
    order, value = carray(orders, _UNKNOWN_SIZE), carray(values, _UNKNOWN_SIZE)
    number = int(count)
    status = _room(whole, 3 * number)
    if status > _LAST_GOOD:
        return types.int32(status)
    part = whole[0]
    at = _begin(whole, SET_DERIVATIVES, number)
    words = carray(at_address(part.words), at + 3 * number, np.int64)
    reals = carray(at_address(part.words), at + 3 * number, np.float64)
    for i in range(number):
        words[at + i], words[at + number + i] = reference[i], order[i]
        reals[at + 2 * number + i] = value[i]
    part.used = at + 3 * number
    return types.int32(_collected(whole, SET_DERIVATIVES))


@allocating
def _same_rates(memory: np.ndarray, references: np.ndarray, orders: np.ndarray, count: int) -> bool:
    """True if these are the derivatives that were read last."""
    part = memory[0]
    if part.rate_count != count:
        return False
    kept = carray(at_address(part.rates), part.rate_count, np.uint32)
    order = carray(at_address(part.orders), part.rate_count, np.int32)
    for i in range(count):
        if kept[i] != references[i] or order[i] != orders[i]:
            return False
    return True


@c_function(_DERIVATIVES)
def get_derivatives(memory, references, count, orders, values):  # noqa: ANN001, ANN201
    """fmi2GetRealOutputDerivatives: what came with the last step, or a message of its own."""
    whole, reference = carray(memory, 1), carray(references, _UNKNOWN_SIZE)
    order, value = carray(orders, _UNKNOWN_SIZE), carray(values, _UNKNOWN_SIZE)
    part, number = whole[0], int(count)
    if not (part.rate_valid and _same_rates(whole, reference, order, number)):
        status = _room(whole, part.count + 2 * number + 4)
        if status > _LAST_GOOD:
            return types.int32(status)
        kept = carray(at_address(part.rates), number, np.uint32)
        kept_order = carray(at_address(part.orders), number, np.int32)
        for i in range(number):
            kept[i], kept_order[i] = reference[i], order[i]
        part.rate_count = number
        _ask(whole)
        _ask_rates(whole)
        status = _send(whole)
        if status > _LAST_GOOD:
            return types.int32(status)
        _keep(whole, True)
    if part.rate_status <= _LAST_GOOD:
        found = carray(at_address(part.rate_found), number, np.float64)
        for i in range(number):
            value[i] = found[i]
    return types.int32(part.rate_status)


@c_function(types.int32(_INSTANCE))
def send(memory):  # noqa: ANN001, ANN201
    """Send what was collected, because Python asks next; FMI status."""
    whole = carray(memory, 1)
    whole[0].valid = whole[0].rate_valid = 0
    return types.int32(_send(whole) if whole[0].used > 0 else 0)

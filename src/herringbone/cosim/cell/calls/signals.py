"""FMI 2.0 functions in front of those of a part in a cell, at C addresses.

The component pointer is the address of the instance's memory, a record of type `block.INSTANCE`. A
step is posted and not waited for if its outputs were read after the last one: then they are read
after this one, too, and whether it failed is said there. So other parts step meanwhile.
"""

import numpy as np
from numba import carray, from_dtype, types

from herringbone.cosim.cell.block import INSTANCE, KINDS, SET, STEP
from herringbone.cosim.cell.calls.messages import LAST_GOOD, land, launch, room
from herringbone.cosim.cell.calls.messages import send as send_all
from herringbone.cosim.cell.calls.operations import (
    ask,
    ask_later,
    begin,
    collected,
    launch_step,
    step_now,
)
from herringbone.cosim.loops.calls import at_address
from herringbone.kernels.compiling.jit import UNKNOWN_SIZE, allocating, c_function

INSTANCE_POINTER = types.CPointer(from_dtype(INSTANCE))
_EXCHANGE = types.int32(
    INSTANCE_POINTER, types.CPointer(types.uint32), types.size_t, types.CPointer(types.float64)
)
_STEP = types.int32(INSTANCE_POINTER, types.float64, types.float64, types.int32)
_FINISH = types.int32(INSTANCE_POINTER, types.int64)


@c_function(_EXCHANGE)
def set_real(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """fmi2SetReal."""
    whole, reference = carray(memory, 1), carray(references, UNKNOWN_SIZE)
    value, number = carray(values, UNKNOWN_SIZE), int(count)
    status = room(whole, 2 * number)
    if status > LAST_GOOD:
        return types.int32(status)
    part = whole[0]
    at = begin(whole, SET, number)
    words = carray(at_address(part.words), at + 2 * number, np.int64)
    reals = carray(at_address(part.words), at + 2 * number, np.float64)
    for i in range(number):
        words[at + i], reals[at + number + i] = reference[i], value[i]
    part.used = at + 2 * number
    return types.int32(collected(whole, SET))


@allocating
def _place(kept: np.ndarray, count: int, reference: int, start: int) -> int:
    """Place of an output among those that are read, looked for from `start`; -1 if it is not."""
    for k in range(count):
        at = start + k if start + k < count else start + k - count
        if kept[at] == reference:
            return at
    return -1


@allocating
def _add(memory: np.ndarray, references: np.ndarray, count: int) -> bool:
    """Read these outputs from now on, beside those of before; True if one of them is new."""
    part = memory[0]
    kept = carray(at_address(part.references), part.count + count, np.uint32)
    known, at = part.count, 0
    for i in range(count):
        found = _place(kept, part.count, references[i], at)
        if found < 0:
            kept[part.count] = references[i]
            part.count += 1
        at = found + 1
    return part.count > known


@allocating
def _give(memory: np.ndarray, references: np.ndarray, count: int, values: np.ndarray) -> None:
    """Values of outputs that were read."""
    part = memory[0]
    kept = carray(at_address(part.references), part.count, np.uint32)
    found = carray(at_address(part.found), part.count, np.float64)
    at = 0
    for i in range(count):
        at = _place(kept, part.count, references[i], at)
        values[i] = found[at]
        at += 1


@allocating
def _read_now(memory: np.ndarray) -> int:
    """Read outputs in a message of their own; FMI status."""
    status = room(memory, memory[0].count)
    if status > LAST_GOOD:
        return status
    memory[0].valid = 0
    ask(memory)
    status = send_all(memory)
    return status if status > LAST_GOOD else memory[0].status


@c_function(_EXCHANGE)
def get_real(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """fmi2GetReal: what came with the last step, or a message of its own."""
    whole, reference = carray(memory, 1), carray(references, UNKNOWN_SIZE)
    number = int(count)
    part = whole[0]
    if part.steps > 0:
        part.steps_read, part.steps = part.steps, 0
    part.read = 1
    status = land(whole)
    if status <= LAST_GOOD and _add(whole, reference, number):
        part.valid = 0
    if status <= LAST_GOOD and part.waiting:
        status = step_now(whole)
    if status <= LAST_GOOD and not part.valid:
        status = _read_now(whole)
    if status <= LAST_GOOD and part.status > LAST_GOOD and part.count > number:
        part.count = 0  # one of the others is refused
        _add(whole, reference, number)
        status = _read_now(whole)
    if status > LAST_GOOD:
        return types.int32(status)
    if part.status <= LAST_GOOD:
        _give(whole, reference, number, carray(values, UNKNOWN_SIZE))
    return types.int32(part.status)


@c_function(_STEP)
def do_step(memory, time, step, no_set_before):  # noqa: ANN001, ANN201 (typed by _STEP)
    """fmi2DoStep; the first one is made at once, and so is one whose outputs nobody reads."""
    whole = carray(memory, 1)
    part = whole[0]
    status = room(whole, 4 + part.count + 2 * part.rate_count)
    if status > LAST_GOOD:
        return types.int32(status)
    at = begin(whole, STEP, 2)
    reals = carray(at_address(part.words), at + 2, np.float64)
    reals[at], reals[at + 1] = time, step
    part.used, part.valid, part.rate_valid = at + 2, 0, 0
    part.waiting += 1
    part.steps += 1
    known = carray(at_address(part.known), KINDS, np.uint8)[STEP]
    if known and part.batch:
        return types.int32(0)
    if known and part.read and part.waiting < part.steps_read:
        return types.int32(0)  # more steps come before outputs are read
    read, part.read = part.read, 0
    if known and read:
        launch_step(whole)
        return types.int32(0)
    return types.int32(step_now(whole))


@c_function(_EXCHANGE)
def get_later(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """As `Addresses.get_later` says."""
    whole, number = carray(memory, 1), int(count)
    status = room(whole, number)
    if status > LAST_GOOD:
        return types.int32(status)
    whole[0].batch = 1
    if number > 0:
        given = carray(values, UNKNOWN_SIZE)
        ask_later(whole, carray(references, UNKNOWN_SIZE), number, given.ctypes.data)
    return types.int32(0)


@c_function(_FINISH)
def finish(memory, wait):  # noqa: ANN001, ANN201 (typed by _FINISH)
    """As `Addresses.finish` says."""
    whole = carray(memory, 1)
    if whole[0].used > 0:
        launch(whole)
    whole[0].batch = whole[0].steps = 0
    return types.int32(land(whole) if wait else 0)


@c_function(types.int32(INSTANCE_POINTER))
def send(memory):  # noqa: ANN001, ANN201
    """Send what was collected, because Python asks next; FMI status."""
    whole = carray(memory, 1)
    whole[0].valid = whole[0].rate_valid = 0
    status = land(whole)
    if status <= LAST_GOOD and whole[0].used > 0:
        status = send_all(whole)
    return types.int32(status)

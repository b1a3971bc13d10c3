"""FMI 2.0 functions of derivatives in front of those of a part in a cell; see `signals`."""

import numpy as np
from numba import carray, types

from herringbone.cosim.cell.block import SET_DERIVATIVES
from herringbone.cosim.cell.calls.messages import LAST_GOOD, land, room, send
from herringbone.cosim.cell.calls.operations import ask, ask_rates, begin, collected
from herringbone.cosim.cell.calls.signals import INSTANCE_POINTER
from herringbone.cosim.loops.calls import at_address
from herringbone.kernels.compiling.jit import UNKNOWN_SIZE, allocating, c_function

_DERIVATIVES = types.int32(
    INSTANCE_POINTER,
    types.CPointer(types.uint32),
    types.size_t,
    types.CPointer(types.int32),
    types.CPointer(types.float64),
)


@c_function(_DERIVATIVES)
def set_derivatives(memory, references, count, orders, values):  # noqa: ANN001, ANN201
    """fmi2SetRealInputDerivatives; sent at once until an order is accepted."""
    whole, reference = carray(memory, 1), carray(references, UNKNOWN_SIZE)
    order, value = carray(orders, UNKNOWN_SIZE), carray(values, UNKNOWN_SIZE)
    number = int(count)
    status = room(whole, 3 * number)
    if status > LAST_GOOD:
        return types.int32(status)
    part = whole[0]
    at = begin(whole, SET_DERIVATIVES, number)
    words = carray(at_address(part.words), at + 3 * number, np.int64)
    reals = carray(at_address(part.words), at + 3 * number, np.float64)
    for i in range(number):
        words[at + i], words[at + number + i] = reference[i], order[i]
        reals[at + 2 * number + i] = value[i]
    part.used = at + 3 * number
    return types.int32(collected(whole, SET_DERIVATIVES))


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
    whole, reference = carray(memory, 1), carray(references, UNKNOWN_SIZE)
    order, value = carray(orders, UNKNOWN_SIZE), carray(values, UNKNOWN_SIZE)
    part, number = whole[0], int(count)
    status = land(whole)
    if status > LAST_GOOD:
        return types.int32(status)
    if not (part.rate_valid and _same_rates(whole, reference, order, number)):
        status = room(whole, part.count + 2 * number + 4)
        if status > LAST_GOOD:
            return types.int32(status)
        kept = carray(at_address(part.rates), number, np.uint32)
        kept_order = carray(at_address(part.orders), number, np.int32)
        for i in range(number):
            kept[i], kept_order[i] = reference[i], order[i]
        part.rate_count = number
        ask(whole)
        ask_rates(whole)
        status = send(whole)
        if status > LAST_GOOD:
            return types.int32(status)
    if part.rate_status <= LAST_GOOD:
        found = carray(at_address(part.rate_found), number, np.float64)
        for i in range(number):
            value[i] = found[i]
    return types.int32(part.rate_status)

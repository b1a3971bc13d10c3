"""Inputs of an FMU 3.0 that change within a step, by intermediate update; see `calls`.

FMI 3.0 has no input derivatives. An FMU with intermediate update asks for its inputs at times of
its own choice within a step, and is told the polynomials that the derivatives stand for. As long as
it has never asked, inputs are held at the polynomials' means over the step: many declare the
update, and never ask.
"""

import numpy as np
from numba import carray, from_dtype, types

from herringbone.cosim.fmu.fmi3.memory import MEMORY, ORDERS
from herringbone.cosim.fmu.fmi3.packing import exchange, pack
from herringbone.cosim.loops.calls import at_address
from herringbone.kernels.compiling.jit import UNKNOWN_SIZE, allocating, c_function
from herringbone.kernels.fmi_calls import OK

POINTER = types.CPointer(from_dtype(MEMORY))
"""Of the memory, in the functions' signatures."""
_DERIVATIVES = types.int32(
    POINTER,
    types.CPointer(types.uint32),
    types.size_t,
    types.CPointer(types.int32),
    types.CPointer(types.float64),
)
_UPDATE = types.void(
    POINTER, types.float64, *[types.uint8] * 4, types.CPointer(types.uint8),
    types.CPointer(types.float64),
)  # fmt: skip
_ERROR = 3
_VALUE, _MEAN = 0, 1


@allocating
def _listed(memory: np.ndarray, element: np.int64) -> bool:
    """Whether an input changes within the next step already; if not, it is listed now."""
    part = memory[0]
    inputs = carray(at_address(part.bent_inputs), part.count, np.uint32)
    for i in range(part.bent):
        if inputs[i] == element:
            return True
    inputs[part.bent] = element
    part.bent += 1
    return False


@c_function(_DERIVATIVES)
def set_derivatives(memory, references, count, orders, values):  # noqa: ANN001, ANN201
    """fmi2SetRealInputDerivatives: they belong to the values that are set, and to the next step."""
    whole, reference = carray(memory, 1), carray(references, UNKNOWN_SIZE)
    order, given = carray(orders, UNKNOWN_SIZE), carray(values, UNKNOWN_SIZE)
    part = whole[0]
    slope = carray(at_address(part.slopes), part.count * ORDERS, np.float64)
    start = carray(at_address(part.starts), part.count, np.float64)
    last = carray(at_address(part.values), part.count, np.float64)
    for i in range(count):
        if order[i] < 1 or order[i] > ORDERS:
            return types.int32(_ERROR)
        element = np.int64(reference[i])
        if not _listed(whole, element):
            start[element] = last[element]
            for k in range(ORDERS):
                slope[element * ORDERS + k] = 0.0
        slope[element * ORDERS + order[i] - 1] = given[i]
    return types.int32(OK)


@allocating
def _give(memory: np.ndarray, since: float, what: int) -> int:
    """Set the inputs to their values at a time since the start of the step [s], or to their means.

    FMI status.
    """
    part = memory[0]
    inputs = carray(at_address(part.bent_inputs), part.count, np.uint32)
    slope = carray(at_address(part.slopes), part.count * ORDERS, np.float64)
    start = carray(at_address(part.starts), part.count, np.float64)
    value = carray(at_address(part.values), part.count, np.float64)
    for i in range(part.bent):
        element = np.int64(inputs[i])
        rise = 0.0
        for k in range(ORDERS, 0, -1):
            rise = (rise + slope[element * ORDERS + k - 1]) * since / (k + what)
        value[element] = start[element] + rise
    variables, total = pack(memory, inputs, part.bent)
    return exchange(
        part.set_float64, (part.instance, part.references, variables, part.packed, total)
    )


@allocating
def begin_step(memory: np.ndarray, time: float, step: float) -> None:
    """Inputs before a step from `time` on [s]: as they are, or at their means."""
    part = memory[0]
    part.began = time
    if part.bent > 0:
        part.steps_bent += 1
        if part.asked == 0:
            _give(memory, step, _MEAN)


@c_function(_UPDATE)
def update(memory, time, asks, may_get, finished, may_return, early, end):  # noqa: ANN001, ANN201
    """fmi3IntermediateUpdateCallback; an early return is never asked for, which is to be said."""
    whole, asked = carray(memory, 1), carray(early, 1)
    part = whole[0]
    if asked.ctypes.data != 0:
        asked[0] = 0
    if asks != 0 and part.bent > 0:
        part.asked += 1
        _give(whole, time - part.began, _VALUE)

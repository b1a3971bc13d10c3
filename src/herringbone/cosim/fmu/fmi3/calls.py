"""FMI 2.0 functions in front of the FMI 3.0 functions of a part, at C addresses.

So the compiled loop treats an FMU 3.0 as it treats an FMU 2.0. The component pointer is the address
of the part's memory, a record of type `memory.MEMORY`; steps are taken in `steps`. The
loop knows scalars only: it sees the elements of an array, which FMI 3.0 sets and gets as a whole.
Therefore the part remembers the last value of every element, and a call exchanges all elements of
the variables that it touches. What is remembered of inputs is what the FMU holds: a restored state
brings its own back.

The kernels view memory as arrays of given types, which numba compiles with counted references only.
"""

import numpy as np
from numba import carray, types

from herringbone.cosim.fmu.fmi3.memory import ELEMENT
from herringbone.cosim.fmu.fmi3.packing import exchange, pack, unpack
from herringbone.cosim.fmu.fmi3.steps import any_discrete, enter_events, leave_events
from herringbone.cosim.fmu.fmi3.within import POINTER
from herringbone.cosim.loops.calls import at_address, c_call, of_state
from herringbone.cosim.loops.common import LAST_GOOD
from herringbone.kernels.compiling.jit import UNKNOWN_SIZE, allocating, c_function
from herringbone.kernels.fmi_calls import OK

_EXCHANGE = types.int32(
    POINTER, types.CPointer(types.uint32), types.size_t, types.CPointer(types.float64)
)
_STATE = types.int32(POINTER, types.int64)
_DERIVATIVES = types.int32(
    POINTER, types.CPointer(types.uint32), types.size_t, types.int64, types.int64
)


_derivatives = c_call("address", "address", "count", "address", "address", "count")
"""fmi3GetOutputDerivatives."""


@allocating
def _update(memory: np.ndarray, references: np.ndarray, count: int) -> int:
    """Get the variables of these elements from the FMU; FMI status."""
    part = memory[0]
    variables, total = pack(memory, references, count)
    status = exchange(
        part.get_float64, (part.instance, part.references, variables, part.packed, total)
    )
    unpack(memory, references, count)
    return status


@c_function(_EXCHANGE)
def set_real(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """fmi2SetReal; what changes at events only is set at one."""
    whole, reference = carray(memory, 1), carray(references, UNKNOWN_SIZE)
    given = carray(values, UNKNOWN_SIZE)
    part = whole[0]
    last = carray(at_address(part.values), part.count, np.float64)
    for i in range(count):
        last[reference[i]] = given[i]
    variables, total = pack(whole, reference, count)
    event = any_discrete(whole, reference, count)
    if event:
        status = enter_events(whole)
        if status > LAST_GOOD:
            return types.int32(status)
    status = exchange(
        part.set_float64, (part.instance, part.references, variables, part.packed, total)
    )
    if event and status <= LAST_GOOD:
        return types.int32(max(status, leave_events(whole)))
    return types.int32(status)


@c_function(_EXCHANGE)
def get_real(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """fmi2GetReal."""
    whole, reference = carray(memory, 1), carray(references, UNKNOWN_SIZE)
    wanted = carray(values, UNKNOWN_SIZE)
    part = whole[0]
    status = _update(whole, reference, count)
    last = carray(at_address(part.values), part.count, np.float64)
    for i in range(count):
        wanted[i] = last[reference[i]]
    return status


@c_function(_STATE)
def get_state(memory, handle):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2GetFMUstate."""
    part = carray(memory, 1)[0]
    part.saved, part.saved_event = part.ended, part.next_event
    return of_state(part.get_state, (part.instance, handle))


@c_function(_STATE)
def set_state(memory, state):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2SetFMUstate; inputs that are arrays are remembered as the state has them."""
    whole = carray(memory, 1)
    part = whole[0]
    status = of_state(part.set_state, (part.instance, state))
    part.ended, part.next_event, part.bent = part.saved, part.saved_event, 0
    if status == OK and part.array_count > 0:
        arrays = carray(at_address(part.arrays), part.array_count, np.uint32)
        return _update(whole, arrays, part.array_count)
    return status


@c_function(_STATE)
def free_state(memory, handle):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2FreeFMUstate."""
    part = carray(memory, 1)[0]
    return of_state(part.free_state, (part.instance, handle))


@c_function(_DERIVATIVES)
def get_derivatives(memory, references, count, orders, values):  # noqa: ANN001, ANN201
    """fmi2GetRealOutputDerivatives, of scalars; the others' number of values is refused."""
    part = carray(memory, 1)[0]
    given = carray(references, UNKNOWN_SIZE)
    element = carray(at_address(part.elements), part.count, ELEMENT)
    reference = carray(at_address(part.references), part.count, np.uint32)
    for i in range(count):
        reference[i] = element[given[i]].reference
    return _derivatives(
        part.get_derivatives, (part.instance, part.references, count, orders, values, count)
    )

"""FMI 2.0 functions in front of the FMI 3.0 functions of a part, at C addresses.

So the compiled loop treats an FMU 3.0 as it treats an FMU 2.0. The component pointer is the address
of the part's memory, a record of type `MEMORY`. The loop knows scalars only: it sees the elements
of an array, which FMI 3.0 sets and gets as a whole. Therefore the part remembers the last value of
every element, and a call exchanges all elements of the variables that it touches. What is
remembered of inputs is what the FMU holds: a restored state brings its own back.

The kernels view memory as arrays of given types, which numba compiles with counted references only.
"""

import numpy as np
from llvmlite import ir
from numba import carray, from_dtype, types
from numba.core import cgutils
from numba.extending import intrinsic

from herringbone.cosim.loops.calls import at_address, c_call, state_call
from herringbone.cosim.loops.common import LAST_GOOD
from herringbone.kernels.fmi_calls import DISCARD, OK
from herringbone.kernels.jit import allocating, c_function

MEMORY = np.dtype(
    [
        ("instance", np.int64),
        ("set_float64", np.int64),
        ("get_float64", np.int64),
        ("do_step", np.int64),
        ("get_state", np.int64),
        ("set_state", np.int64),
        ("free_state", np.int64),
        ("get_derivatives", np.int64),
        ("count", np.int64),
        ("elements", np.int64),
        ("values", np.int64),
        ("references", np.int64),
        ("packed", np.int64),
        ("arrays", np.int64),
        ("array_count", np.int64),
        ("calls", np.int64),
        ("ended", np.int64),
        ("saved", np.int64),
        ("reached", np.int64),
        ("events", np.int64),
        ("enter_events", np.int64),
        ("update", np.int64),
        ("enter_steps", np.int64),
        ("flags", np.int64),
    ]
)
"""What an FMU 3.0 is for its adapters.

instance, and the addresses of its functions; count of elements; addresses of the elements, of their
last values (float64), and of the value references (uint32) and values (float64) of the current
call, and of the first elements of the inputs that are arrays (uint32), with their number; number of
calls; ended: why no step follows, see `ENDED`; saved: the same, of the state saved last; address of
the time reached by the last step (float64); events: 1 in step mode if event mode is used; addresses
of fmi3EnterEventMode, fmi3UpdateDiscreteStates and fmi3EnterStepMode; address of the flags that
they return (uint8 and, from the eighth on, float64).
"""
ELEMENT = np.dtype(
    [
        ("reference", np.int64),
        ("first", np.int64),
        ("size", np.int64),
        ("call", np.int64),
        ("discrete", np.int64),
    ]
)
"""An element: value reference, first element and size of its variable; at the first element, the
number of the last call that exchanged the variable; discrete: 1 if it changes at events only."""
RUNS, ENDED, EARLY, STUCK = 0, 1, 2, 3
"""It goes on; it asked to end the simulation; it returned early without leave, or again and again;
its discrete states never settle."""

_MEMORY = types.CPointer(from_dtype(MEMORY))
_EXCHANGE = types.int32(
    _MEMORY, types.CPointer(types.uint32), types.size_t, types.CPointer(types.float64)
)
_STEP = types.int32(_MEMORY, types.float64, types.float64, types.int32)
_STATE = types.int32(_MEMORY, types.int64)
_DERIVATIVES = types.int32(
    _MEMORY, types.CPointer(types.uint32), types.size_t, types.int64, types.int64
)
_UNKNOWN_SIZE = 1  # bounds are not checked
_EVENT, _TERMINATE, _EARLY = 256, 512, 1024  # added to the status of a step
_MOST_EVENTS = 1000
"""In a step, and iterations of one."""
_ERROR = 3
_INT32, _DOUBLE, _BOOLEAN = ir.IntType(32), ir.DoubleType(), ir.IntType(8)


_exchange = c_call("address", "address", "count", "address", "count")
"""fmi3SetFloat64 or fmi3GetFloat64."""
_derivatives = c_call("address", "address", "count", "address", "address", "count")
"""fmi3GetOutputDerivatives."""


_call = c_call("address")
"""fmi3EnterEventMode or fmi3EnterStepMode."""
_update_states = c_call(*["address"] * 7)
"""fmi3UpdateDiscreteStates."""


@intrinsic
def _step(typing_context, address, instance, time, step, no_set_before, reached):  # noqa: ANN001, ANN202
    """fmi3DoStep at `address`: its status and flags; `reached`: address of its last time."""
    signature = types.int32(
        types.int64, types.int64, types.float64, types.float64, types.int32, types.int64
    )

    def generate(context, builder, signature, arguments):  # noqa: ANN001, ANN202
        pointer = cgutils.voidptr_t
        kind = ir.FunctionType(_INT32, [pointer, _DOUBLE, _DOUBLE, _INT32, *[pointer] * 4])
        target, instance, time, step, no_set_before, reached = arguments
        flags = [cgutils.alloca_once_value(builder, ir.Constant(_BOOLEAN, 0)) for _ in range(3)]
        for flag in flags:
            builder.store(ir.Constant(_BOOLEAN, 0), flag)
        status = builder.call(
            builder.inttoptr(target, kind.as_pointer()),
            [
                builder.inttoptr(instance, pointer),
                time,
                step,
                no_set_before,
                *flags,
                builder.inttoptr(reached, pointer),
            ],
        )
        for flag, number in zip(flags, (_EVENT, _TERMINATE, _EARLY), strict=True):
            on = builder.icmp_unsigned("!=", builder.load(flag), ir.Constant(_BOOLEAN, 0))
            status = builder.add(status, builder.select(on, _INT32(number), _INT32(0)))
        return status

    return signature, generate


@allocating
def _enter_events(memory: np.ndarray) -> int:
    """Go from step mode to event mode; FMI status."""
    part = memory[0]
    return _call(part.enter_events, (part.instance,))


@allocating
def _leave_events(memory: np.ndarray) -> int:
    """Settle the discrete states and go back to step mode; FMI status."""
    part = memory[0]
    flag = carray(at_address(part.flags), 5, np.uint8)
    for _ in range(_MOST_EVENTS):
        f = part.flags
        status = _update_states(part.update, (part.instance, f, f + 1, f + 2, f + 3, f + 4, f + 8))
        if status > LAST_GOOD:
            return status
        if flag[1]:
            part.ended = ENDED
        if flag[0] == 0 or flag[1]:
            return _call(part.enter_steps, (part.instance,))
    part.ended = STUCK
    return _ERROR


@allocating
def _any_discrete(memory: np.ndarray, references: np.ndarray, count: int) -> bool:
    """True if one of these elements changes at events only, and events are handled here."""
    part = memory[0]
    if part.events == 0:
        return False
    element = carray(at_address(part.elements), part.count, ELEMENT)
    for i in range(count):
        if element[references[i]].discrete:
            return True
    return False


@allocating
def _pack(memory: np.ndarray, references: np.ndarray, count: int) -> tuple[int, int]:
    """Variables of these elements and their last values, to the current call; how many of each."""
    part = memory[0]
    part.calls += 1
    element = carray(at_address(part.elements), part.count, ELEMENT)
    value = carray(at_address(part.values), part.count, np.float64)
    reference = carray(at_address(part.references), part.count, np.uint32)
    packed = carray(at_address(part.packed), part.count, np.float64)
    variables, total = 0, 0
    for i in range(count):
        first = element[references[i]].first
        if element[first].call != part.calls:
            element[first].call = part.calls
            reference[variables] = element[first].reference
            variables += 1
            for k in range(first, first + element[first].size):
                packed[total] = value[k]
                total += 1
    return variables, total


@allocating
def _unpack(memory: np.ndarray, references: np.ndarray, count: int) -> None:
    """Values of the current call, to the elements of the variables in the order of `_pack`."""
    part = memory[0]
    element = carray(at_address(part.elements), part.count, ELEMENT)
    value = carray(at_address(part.values), part.count, np.float64)
    packed = carray(at_address(part.packed), part.count, np.float64)
    total = 0
    for i in range(count):
        first = element[references[i]].first
        if element[first].call == part.calls:
            element[first].call = 0
            for k in range(first, first + element[first].size):
                value[k] = packed[total]
                total += 1


@allocating
def _update(memory: np.ndarray, references: np.ndarray, count: int) -> int:
    """Get the variables of these elements from the FMU; FMI status."""
    part = memory[0]
    variables, total = _pack(memory, references, count)
    status = _exchange(
        part.get_float64, (part.instance, part.references, variables, part.packed, total)
    )
    _unpack(memory, references, count)
    return status


@c_function(_EXCHANGE)
def set_real(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """fmi2SetReal; what changes at events only is set at one."""
    whole, reference = carray(memory, 1), carray(references, _UNKNOWN_SIZE)
    given = carray(values, _UNKNOWN_SIZE)
    part = whole[0]
    last = carray(at_address(part.values), part.count, np.float64)
    for i in range(count):
        last[reference[i]] = given[i]
    variables, total = _pack(whole, reference, count)
    event = _any_discrete(whole, reference, count)
    if event:
        status = _enter_events(whole)
        if status > LAST_GOOD:
            return types.int32(status)
    status = _exchange(
        part.set_float64, (part.instance, part.references, variables, part.packed, total)
    )
    if event and status <= LAST_GOOD:
        return types.int32(max(status, _leave_events(whole)))
    return types.int32(status)


@c_function(_EXCHANGE)
def get_real(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """fmi2GetReal."""
    whole, reference = carray(memory, 1), carray(references, _UNKNOWN_SIZE)
    wanted = carray(values, _UNKNOWN_SIZE)
    part = whole[0]
    status = _update(whole, reference, count)
    last = carray(at_address(part.values), part.count, np.float64)
    for i in range(count):
        wanted[i] = last[reference[i]]
    return status


@allocating
def _advance(memory: np.ndarray, time: float, step: float, no_set_before: int) -> tuple[int, bool]:
    """One fmi3DoStep, and the event at its end: FMI status, and whether time is left."""
    part = memory[0]
    last = carray(at_address(part.reached), 1, np.float64)
    end = time + step
    found = _step(part.do_step, part.instance, time, step, no_set_before, part.reached)
    status, early = found % _EVENT, found >= _EARLY and last[0] < end
    if not early:
        last[0] = end
    if status > LAST_GOOD:
        return status, False
    if found % _EARLY >= _TERMINATE:
        part.ended = ENDED
    elif part.events and (early or found % _TERMINATE >= _EVENT):
        status = _enter_events(memory)
        if status <= LAST_GOOD:
            status = _leave_events(memory)
    elif early:
        part.ended = EARLY
    return status, early


@c_function(_STEP)
def do_step(memory, time, step, no_set_before):  # noqa: ANN001, ANN201 (typed by _STEP)
    """fmi2DoStep; events are handled where the FMU stops for them.

    After a whole step with the wish to end the simulation the next one is discarded; a step that
    ends early for good is discarded itself.
    """
    whole = carray(memory, 1)
    part = whole[0]
    last = carray(at_address(part.reached), 1, np.float64)
    if part.ended != RUNS:
        return types.int32(DISCARD)
    status, left = _advance(whole, time, step, no_set_before)
    stops = 1
    while left and status <= LAST_GOOD and part.ended == RUNS and stops < _MOST_EVENTS:
        at = last[0]
        status, left = _advance(whole, at, time + step - at, no_set_before)
        stops += 1
    if left and part.ended == RUNS:
        part.ended = EARLY
    return types.int32(max(status, DISCARD) if left else status)


@c_function(_STATE)
def get_state(memory, handle):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2GetFMUstate."""
    part = carray(memory, 1)[0]
    part.saved = part.ended
    return state_call(part.get_state, part.instance, handle)


@c_function(_STATE)
def set_state(memory, state):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2SetFMUstate; inputs that are arrays are remembered as the state has them."""
    whole = carray(memory, 1)
    part = whole[0]
    status = state_call(part.set_state, part.instance, state)
    part.ended = part.saved
    if status == OK and part.array_count > 0:
        arrays = carray(at_address(part.arrays), part.array_count, np.uint32)
        return _update(whole, arrays, part.array_count)
    return status


@c_function(_STATE)
def free_state(memory, handle):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2FreeFMUstate."""
    part = carray(memory, 1)[0]
    return state_call(part.free_state, part.instance, handle)


@c_function(_DERIVATIVES)
def get_derivatives(memory, references, count, orders, values):  # noqa: ANN001, ANN201
    """fmi2GetRealOutputDerivatives, of scalars; the others' number of values is refused."""
    part = carray(memory, 1)[0]
    given = carray(references, _UNKNOWN_SIZE)
    element = carray(at_address(part.elements), part.count, ELEMENT)
    reference = carray(at_address(part.references), part.count, np.uint32)
    for i in range(count):
        reference[i] = element[given[i]].reference
    return _derivatives(
        part.get_derivatives, (part.instance, part.references, count, orders, values, count)
    )

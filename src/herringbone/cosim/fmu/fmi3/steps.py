"""Steps and events of an FMU 3.0 behind an FMI 2.0 function, at C addresses; see `calls`.

An FMU with event mode stops for an event, at the end of a step or by an early return, or tells its
time before (FMI 3.0, nextEventTime: the master steps up to it, or slightly further where steps have
one length). The event is handled here, and the rest of the step follows.
"""

import numpy as np
from llvmlite import ir
from numba import carray, types
from numba.core import cgutils
from numba.extending import intrinsic

from herringbone.cosim.fmu.fmi3.memory import EARLY, ELEMENT, ENDED, RUNS, STUCK
from herringbone.cosim.fmu.fmi3.within import POINTER, begin_step
from herringbone.cosim.loops.calls import at_address, c_call
from herringbone.cosim.loops.common import LAST_GOOD
from herringbone.kernels.compiling.jit import allocating, c_function
from herringbone.kernels.fmi_calls import DISCARD

_STEP = types.int32(POINTER, types.float64, types.float64, types.int32)
_EVENT, _TERMINATE, _EARLY = 256, 512, 1024  # added to the status of a step
_MOST_EVENTS = 1000
"""In a step, and iterations of one."""
_ERROR = 3
_NEAR = 1e-9
"""Of a step: so near its ends an event that was told before lies at them."""
_INT32, _DOUBLE, _BOOLEAN = ir.IntType(32), ir.DoubleType(), ir.IntType(8)


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
def enter_events(memory: np.ndarray) -> int:
    """Go from step mode to event mode; FMI status."""
    part = memory[0]
    return _call(part.enter_events, (part.instance,))


@allocating
def leave_events(memory: np.ndarray) -> int:
    """Settle the discrete states and go back to step mode; FMI status."""
    part = memory[0]
    flag = carray(at_address(part.flags), 5, np.uint8)
    for _ in range(_MOST_EVENTS):
        f = part.flags
        status = _update_states(part.update, (part.instance, f, f + 1, f + 2, f + 3, f + 4, f + 8))
        if status > LAST_GOOD:
            return status
        told = carray(at_address(f + 8), 1, np.float64)
        part.next_event = told[0] if flag[4] else np.inf
        if flag[1]:
            part.ended = ENDED
        if flag[0] == 0 or flag[1]:
            return _call(part.enter_steps, (part.instance,))
    part.ended = STUCK
    return _ERROR


@allocating
def any_discrete(memory: np.ndarray, references: np.ndarray, count: int) -> bool:
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
def _advance(memory: np.ndarray, time: float, step: float, no_set_before: int) -> tuple[int, bool]:
    """One fmi3DoStep, and the event at its end: FMI status, and whether time is left."""
    part = memory[0]
    last = carray(at_address(part.reached), 1, np.float64)
    end, length = time + step, step
    awaited = part.next_event - time
    if part.events and part.varies and _NEAR * step < awaited < (1.0 - _NEAR) * step:
        length = awaited
    last[0] = end
    found = _step(part.do_step, part.instance, time, length, no_set_before, part.reached)
    status, ends = found % _EVENT, found % _EARLY >= _TERMINATE
    early = found >= _EARLY and last[0] < time + length
    if not early and not (ends and time < last[0] < end - _NEAR * step):
        last[0] = end if length == step else part.next_event
    left = last[0] < end
    if status > LAST_GOOD:
        return status, False
    if ends:
        part.ended = ENDED
    elif part.events and (
        early or found % _TERMINATE >= _EVENT or part.next_event - last[0] <= _NEAR * step
    ):
        status = enter_events(memory)
        if status <= LAST_GOOD:
            status = leave_events(memory)
    elif early:
        part.ended = EARLY
    return status, left


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
    begin_step(whole, time, step)
    status, left = _advance(whole, time, step, no_set_before)
    stops = 1
    while left and status <= LAST_GOOD and part.ended == RUNS and stops < _MOST_EVENTS:
        at = last[0]
        status, left = _advance(whole, at, time + step - at, no_set_before)
        stops += 1
    part.bent = 0
    if left and part.ended == RUNS:
        part.ended = EARLY
    return types.int32(max(status, DISCARD) if left else status)

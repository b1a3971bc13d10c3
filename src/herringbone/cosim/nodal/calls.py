r"""FMI 2.0 functions in front of those of a part that holds its inputs, at C addresses.

The part behind them takes one value per input and step. In front of it, inputs and outputs are
polynomial signals of degree d over the macro step, as those of the components: values at the nodes
c = 0, 1/d, ... 1. From node to node the part takes one step or two; what it holds in them is said
in `nodal.held`. What passes directly to its outputs is the value held last, where the value at the
end is wanted:

    y(c1) = y + D (u(c1) - u_held),

with D the direct feedthrough (see `cosim.signature`). A part without memory is given u(c1) instead.
An input that runs on with its rate r inside the part, as an angle with its speed, has come to
u_held + (t(c1) - t(c0)) r_held at the end; D acts on what is missing there.

The component pointer is the address of the part's memory, a record of type `MEMORY`. Only inputs
that were set once are set; others keep their start values. References of this interface: input i at
node k is i STRIDE + k, output j at node k (n + j) STRIDE + k; node 0 of an output is its end value.
"""

import numpy as np
from numba import carray, types

from herringbone.cosim.loops.calls import at_address, exchange_reals, state_call
from herringbone.cosim.loops.common import LAST_GOOD
from herringbone.cosim.nodal.memory import MEMORY_POINTER
from herringbone.cosim.nodal.once import answer
from herringbone.cosim.nodal.steps import end, expand, read, settle, take
from herringbone.cosim.nodal.watch import measure_if_suspected
from herringbone.kernels.compiling.jit import UNKNOWN_SIZE, c_function
from herringbone.kernels.signals import STRIDE

_EXCHANGE = types.int32(
    MEMORY_POINTER, types.CPointer(types.uint32), types.size_t, types.CPointer(types.float64)
)
_STEP = types.int32(MEMORY_POINTER, types.float64, types.float64, types.int32)
_STATE = types.int32(MEMORY_POINTER, types.int64)


@c_function(_EXCHANGE)
def set_real(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """fmi2SetReal, of inputs at nodes."""
    whole = carray(memory, 1)
    status = settle(whole)
    if status > LAST_GOOD:
        return types.int32(status)
    part = whole[0]
    reference, value = carray(references, UNKNOWN_SIZE), carray(values, UNKNOWN_SIZE)
    given = carray(at_address(part.given), part.inputs * STRIDE, np.float64)
    driven = carray(at_address(part.driven), part.inputs, np.int64)
    for i in range(count):
        given[reference[i]] = value[i]
        driven[reference[i] // STRIDE] = 1
    return types.int32(0)


@c_function(_EXCHANGE)
def get_real(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """fmi2GetReal, of outputs at nodes; before the first step those of the part."""
    whole = carray(memory, 1)
    part = whole[0]
    reference, value = carray(references, UNKNOWN_SIZE), carray(values, UNKNOWN_SIZE)
    kept = carray(at_address(part.values), part.outputs * STRIDE, np.float64)
    whole[0].read = 1
    status = settle(whole)
    if status > LAST_GOOD:
        return types.int32(status)
    if part.stepped == 0:
        status = read(whole, False)
        raw = carray(at_address(part.raw), part.outputs, np.float64)
        for j in range(part.outputs):
            kept[j * STRIDE] = raw[j]
    for i in range(count):
        value[i] = kept[reference[i] - part.inputs * STRIDE]
    return types.int32(status)


@c_function(_STEP)
def do_step(memory, time, step, no_set_before):  # noqa: ANN001, ANN201 (typed by _STEP)
    """fmi2DoStep, from node to node.

    Of a part that answers later the outputs come when they are read, if they were after the last
    step; then, too, it is said whether this one failed.
    """
    whole = carray(memory, 1)
    status = settle(whole)
    if status > LAST_GOOD:
        return types.int32(status)
    part = whole[0]
    if part.once and part.taken_time == time and part.taken_step == step:
        answer(whole)
        return types.int32(0)
    expand(whole)
    later = part.finish != 0
    if later:
        exchange_reals(part.get_later, part.component, 0, 0, 0)
    status = take(whole, time, step, later)
    if status > LAST_GOOD:
        return types.int32(status)
    if not later:
        end(whole, time, step)
        return types.int32(0)
    whole[0].pending, whole[0].pending_time, whole[0].pending_step = 1, time, step
    wanted, whole[0].read = part.read, 0
    if wanted:
        return types.int32(state_call(part.finish, part.component, 0))
    return types.int32(settle(whole))


@c_function(_STATE)
def get_state(memory, handle):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2GetFMUstate, before a step; the adapter itself has no state: a step sets all it knows."""
    whole = carray(memory, 1)
    status = settle(whole)
    if status > LAST_GOOD:
        return types.int32(status)
    part = whole[0]
    status = measure_if_suspected(whole)
    if status > LAST_GOOD:
        return types.int32(status)
    whole[0].saved_time = part.state_time
    return types.int32(state_call(part.get_state, part.component, handle))


@c_function(_STATE)
def set_state(memory, state):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2SetFMUstate, of the state that was saved last."""
    whole = carray(memory, 1)
    status = settle(whole)
    if status > LAST_GOOD:
        return types.int32(status)
    part = whole[0]
    whole[0].state_time = part.saved_time
    return types.int32(state_call(part.set_state, part.component, state))


@c_function(_STATE)
def free_state(memory, handle):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2FreeFMUstate."""
    part = carray(memory, 1)[0]
    return state_call(part.free_state, part.component, handle)

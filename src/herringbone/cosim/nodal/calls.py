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
from herringbone.cosim.loops.calls import do_step as step_part
from herringbone.cosim.loops.common import LAST_GOOD
from herringbone.cosim.nodal.held import hold
from herringbone.cosim.nodal.memory import MEMORY_POINTER
from herringbone.cosim.nodal.once import answer, make_up, remember
from herringbone.cosim.nodal.watch import compare, measure_if_suspected
from herringbone.cosim.signature.rotation import Given
from herringbone.kernels.jit import allocating, c_function
from herringbone.kernels.signals import STRIDE, evaluate, monomial

_EXCHANGE = types.int32(
    MEMORY_POINTER, types.CPointer(types.uint32), types.size_t, types.CPointer(types.float64)
)
_STEP = types.int32(MEMORY_POINTER, types.float64, types.float64, types.int32)
_STATE = types.int32(MEMORY_POINTER, types.int64)
_UNKNOWN_SIZE = 1  # bounds are not checked
_START = int(Given.START)
_BYTES = 8


@allocating
def _read(memory: np.ndarray, later: bool) -> int:
    """Outputs of the part, as they are, now or when it has answered; FMI status."""
    part = memory[0]
    if part.outputs == 0:
        return 0
    function = part.get_later if later else part.get_real
    return exchange_reals(function, part.component, part.output_references, part.outputs, part.raw)


@allocating
def _expand(memory: np.ndarray) -> None:
    """Coefficients of the input signals."""
    part = memory[0]
    given = carray(at_address(part.given), part.inputs * STRIDE, np.float64)
    coefficients = carray(at_address(part.coefficients), part.inputs * STRIDE, np.float64)
    for i in range(part.inputs):
        monomial(given, i * STRIDE, part.degree, coefficients, i * STRIDE)


@allocating
def _give(memory: np.ndarray, piece: int) -> int:
    """Set the inputs of the part to what it holds in a piece; FMI status."""
    part = memory[0]
    driven = carray(at_address(part.driven), part.inputs, np.int64)
    held = carray(at_address(part.held), 2 * part.inputs, np.float64)
    packed = carray(at_address(part.packed), part.inputs, np.float64)
    references = carray(at_address(part.input_references), part.inputs, np.uint32)
    packed_references = carray(at_address(part.packed_references), part.inputs, np.uint32)
    count = 0
    for i in range(part.inputs):
        if driven[i] == 0:
            continue
        packed[count], packed_references[count] = held[piece * part.inputs + i], references[i]
        count += 1
    if count == 0:
        return 0
    return exchange_reals(part.set_real, part.component, part.packed_references, count, part.packed)


@allocating
def _keep(memory: np.ndarray, node: int, end: float, length: float) -> None:
    """Outputs at a node: those of the part, and what passes directly; `length` of the piece [s]."""
    part = memory[0]
    coefficients = carray(at_address(part.coefficients), part.inputs * STRIDE, np.float64)
    driven = carray(at_address(part.driven), part.inputs, np.int64)
    held = carray(at_address(part.held), 2 * part.inputs, np.float64)
    raw = carray(at_address(part.raw), part.outputs, np.float64)
    values = carray(at_address(part.values), part.outputs * STRIDE, np.float64)
    feedthrough = carray(at_address(part.feedthrough), part.outputs * part.inputs, np.float64)
    place = carray(at_address(part.place), part.inputs, np.int64)
    rate = carray(at_address(part.rate), part.inputs, np.int64)
    last = (part.pieces - 1) * part.inputs
    for j in range(part.outputs):
        value = raw[j]
        if part.at_end == 0 and part.degree > 0:
            for i in range(part.inputs):
                passed = feedthrough[j * part.inputs + i]
                if driven[i] and passed != 0.0:
                    at_end = evaluate(coefficients, i * STRIDE, part.degree, end)
                    seen = held[last + i]
                    if place[i] == _START and rate[i] >= 0:
                        seen += length * held[last + rate[i]]
                    value += passed * (at_end - seen)
        values[j * STRIDE + node] = value
        values[j * STRIDE] = value


@allocating
def _at_node(memory: np.ndarray, node: int) -> None:
    """What is held, and what is read, is that of a node now."""
    part = memory[0]
    memory[0].held = part.all_held + _BYTES * 2 * part.inputs * (node - 1)
    memory[0].raw = part.all_raw + _BYTES * part.outputs * (node - 1)


@allocating
def _take(memory: np.ndarray, time: float, step: float, later: bool) -> int:
    """Step the part from node to node; FMI status."""
    part = memory[0]
    nodes = max(1, part.degree)
    length = step / (nodes * part.pieces)
    for node in range(1, nodes + 1):
        _at_node(memory, node)
        hold(memory, (node - 1) / nodes, node / nodes, step)
        if part.once:
            make_up(memory, step)
        for piece in range(part.pieces):
            status = _give(memory, piece)
            if status > LAST_GOOD:
                return status
            begin = time + ((node - 1) * part.pieces + piece) * length
            status = step_part(part.do_step, part.component, begin, length)
            if status > LAST_GOOD:
                return status
        status = _read(memory, later)
        if status > LAST_GOOD:
            return status
    return 0


@allocating
def _end(memory: np.ndarray, time: float, step: float) -> None:
    """The outputs of a step are there: signals, and what is remembered."""
    part = memory[0]
    nodes = max(1, part.degree)
    length = step / (nodes * part.pieces)
    for node in range(1, nodes + 1):
        _at_node(memory, node)
        if part.watched:
            compare(memory, node, time, step)
        _keep(memory, node, node / nodes, length)
    memory[0].seen_piece, memory[0].stepped, memory[0].state_time = length, 1, time + step
    if part.once:
        remember(memory, time, step)


@allocating
def _settle(memory: np.ndarray) -> int:
    """Wait for the outputs of the last step, if they have not come; FMI status."""
    part = memory[0]
    if part.pending == 0:
        return 0
    memory[0].pending = 0
    status = state_call(part.finish, part.component, 1)
    if status <= LAST_GOOD:
        _end(memory, part.pending_time, part.pending_step)
    return status


@c_function(_EXCHANGE)
def set_real(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """fmi2SetReal, of inputs at nodes."""
    whole = carray(memory, 1)
    status = _settle(whole)
    if status > LAST_GOOD:
        return types.int32(status)
    part = whole[0]
    reference, value = carray(references, _UNKNOWN_SIZE), carray(values, _UNKNOWN_SIZE)
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
    reference, value = carray(references, _UNKNOWN_SIZE), carray(values, _UNKNOWN_SIZE)
    kept = carray(at_address(part.values), part.outputs * STRIDE, np.float64)
    whole[0].read = 1
    status = _settle(whole)
    if status > LAST_GOOD:
        return types.int32(status)
    if part.stepped == 0:
        status = _read(whole, False)
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
    status = _settle(whole)
    if status > LAST_GOOD:
        return types.int32(status)
    part = whole[0]
    if part.once and part.taken_time == time and part.taken_step == step:
        answer(whole)
        return types.int32(0)
    _expand(whole)
    later = part.finish != 0
    if later:
        exchange_reals(part.get_later, part.component, 0, 0, 0)
    status = _take(whole, time, step, later)
    if status > LAST_GOOD:
        return types.int32(status)
    if not later:
        _end(whole, time, step)
        return types.int32(0)
    whole[0].pending, whole[0].pending_time, whole[0].pending_step = 1, time, step
    read, whole[0].read = part.read, 0
    if read:
        return types.int32(state_call(part.finish, part.component, 0))
    return types.int32(_settle(whole))


@c_function(_STATE)
def get_state(memory, handle):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2GetFMUstate, before a step; the adapter itself has no state: a step sets all it knows."""
    whole = carray(memory, 1)
    status = _settle(whole)
    if status > LAST_GOOD:
        return types.int32(status)
    part = whole[0]
    measure_if_suspected(whole)
    whole[0].saved_time = part.state_time
    return types.int32(state_call(part.get_state, part.component, handle))


@c_function(_STATE)
def set_state(memory, state):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2SetFMUstate, of the state that was saved last."""
    whole = carray(memory, 1)
    status = _settle(whole)
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

r"""FMI 2.0 functions in front of those of a part that holds its inputs, at C addresses.

The part behind them takes one value per input and step. In front of it, inputs and outputs are
polynomial signals of degree d over the macro step, as those of the components: values at the nodes
c = 0, 1/d, ... 1. A macro step is as many steps of the part as there are nodes, times `pieces`. In
each of them, from c0 to c1, a part with states holds the mean of the signal u,

    u_held = 1 / (c1 - c0) * integral of u dc from c0 to c1,

which gives its states the right momentum, to the second order of the piece. What passes directly to
its outputs is that mean, where the value at the end is wanted:

    y(c1) = y + D (u(c1) - u_held),

with D the direct feedthrough (see `cosim.signature`). A part without memory is given u(c1) instead.
An input that runs on with its rate r inside the part, as an angle with its speed, is given as
u(c0), and has come to u(c0) + (t(c1) - t(c0)) r_held at the end; D acts on what is missing there.
One that runs up to its value is given as u(c1). See `cosim.signature.rotation`.

The component pointer is the address of the part's memory, a record of type `MEMORY`. Only inputs
that were set once are set; others keep their start values. References of this interface: input i at
node k is i STRIDE + k, output j at node k (n + j) STRIDE + k; node 0 of an output is its end value.
"""

import numpy as np
from numba import carray, from_dtype, types

from herringbone.cosim.loops.calls import at_address, exchange_reals, state_call
from herringbone.cosim.loops.calls import do_step as step_part
from herringbone.cosim.loops.common import LAST_GOOD
from herringbone.cosim.signature.rotation import Given
from herringbone.kernels.jit import allocating, c_function
from herringbone.kernels.signals import STRIDE, evaluate, monomial

MEMORY = np.dtype(
    [
        ("component", np.int64),
        ("set_real", np.int64),
        ("get_real", np.int64),
        ("do_step", np.int64),
        ("get_state", np.int64),
        ("set_state", np.int64),
        ("free_state", np.int64),
        ("inputs", np.int64),
        ("outputs", np.int64),
        ("degree", np.int64),
        ("pieces", np.int64),
        ("at_end", np.int64),
        ("stepped", np.int64),
        ("input_references", np.int64),
        ("output_references", np.int64),
        ("given", np.int64),
        ("driven", np.int64),
        ("coefficients", np.int64),
        ("held", np.int64),
        ("packed", np.int64),
        ("packed_references", np.int64),
        ("raw", np.int64),
        ("values", np.int64),
        ("feedthrough", np.int64),
        ("place", np.int64),
        ("rate", np.int64),
    ]
)
"""What an adapter knows.

component, and the addresses of the part's functions; numbers of inputs n and outputs m; degree of
the signals; pieces: steps per node; at_end: 1 for a part without memory; stepped: 1 after the first
step. Addresses: value references of the part's inputs and outputs (uint32); given: signals of the
inputs (n, STRIDE); driven: 1 for inputs that were set (int64); coefficients (n, STRIDE); held (n);
packed and packed_references: of driven inputs; raw (m) outputs of the part; values: signals of the
outputs (m, STRIDE); feedthrough (m, n); place (n, int64): see
`Given`; rate (n, int64): number of an input's rate, or -1.
"""

_MEMORY = types.CPointer(from_dtype(MEMORY))
_EXCHANGE = types.int32(
    _MEMORY, types.CPointer(types.uint32), types.size_t, types.CPointer(types.float64)
)
_STEP = types.int32(_MEMORY, types.float64, types.float64, types.int32)
_STATE = types.int32(_MEMORY, types.int64)
_UNKNOWN_SIZE = 1  # bounds are not checked
_START, _END = int(Given.START), int(Given.END)


@allocating
def _read(memory: np.ndarray) -> int:
    """Outputs of the part, as they are; FMI status."""
    part = memory[0]
    if part.outputs == 0:
        return 0
    return exchange_reals(
        part.get_real, part.component, part.output_references, part.outputs, part.raw
    )


@allocating
def _expand(memory: np.ndarray) -> None:
    """Coefficients of the input signals."""
    part = memory[0]
    given = carray(at_address(part.given), part.inputs * STRIDE, np.float64)
    coefficients = carray(at_address(part.coefficients), part.inputs * STRIDE, np.float64)
    for i in range(part.inputs):
        monomial(given, i * STRIDE, part.degree, coefficients, i * STRIDE)


@allocating
def _hold(memory: np.ndarray, begin: float, end: float) -> int:
    """Set the inputs of the part for a piece from c = begin to end; FMI status."""
    part = memory[0]
    coefficients = carray(at_address(part.coefficients), part.inputs * STRIDE, np.float64)
    driven = carray(at_address(part.driven), part.inputs, np.int64)
    held = carray(at_address(part.held), part.inputs, np.float64)
    packed = carray(at_address(part.packed), part.inputs, np.float64)
    references = carray(at_address(part.input_references), part.inputs, np.uint32)
    packed_references = carray(at_address(part.packed_references), part.inputs, np.uint32)
    place = carray(at_address(part.place), part.inputs, np.int64)
    count = 0
    for i in range(part.inputs):
        if driven[i] == 0:
            continue
        if part.at_end or place[i] == _END:
            held[i] = evaluate(coefficients, i * STRIDE, part.degree, end)
        elif place[i] == _START:
            held[i] = evaluate(coefficients, i * STRIDE, part.degree, begin)
        else:
            held[i] = _mean(coefficients, i * STRIDE, part.degree, begin, end)
        packed[count], packed_references[count] = held[i], references[i]
        count += 1
    if count == 0:
        return 0
    return exchange_reals(part.set_real, part.component, part.packed_references, count, part.packed)


@allocating
def _mean(coefficients: np.ndarray, at: int, degree: int, begin: float, end: float) -> float:
    """Mean of a polynomial in c: by the powers of its distance from the middle, which is stable."""
    middle, half = 0.5 * (begin + end), 0.5 * (end - begin)
    total = evaluate(coefficients, at, degree, middle)
    curve, third = 0.0, 0.0
    for j in range(degree, 1, -1):
        curve = curve * middle + 0.5 * j * (j - 1.0) * coefficients[at + j]
    for j in range(degree, 3, -1):
        third = third * middle + j * (j - 1.0) * (j - 2.0) * (j - 3.0) / 24.0 * coefficients[at + j]
    return total + half * half * (curve / 3.0 + half * half * third / 5.0)


@allocating
def _keep(memory: np.ndarray, node: int, end: float, length: float) -> None:
    """Outputs at a node: those of the part, and what passes directly; `length` of the piece [s]."""
    part = memory[0]
    coefficients = carray(at_address(part.coefficients), part.inputs * STRIDE, np.float64)
    driven = carray(at_address(part.driven), part.inputs, np.int64)
    held = carray(at_address(part.held), part.inputs, np.float64)
    raw = carray(at_address(part.raw), part.outputs, np.float64)
    values = carray(at_address(part.values), part.outputs * STRIDE, np.float64)
    feedthrough = carray(at_address(part.feedthrough), part.outputs * part.inputs, np.float64)
    place = carray(at_address(part.place), part.inputs, np.int64)
    rate = carray(at_address(part.rate), part.inputs, np.int64)
    for j in range(part.outputs):
        value = raw[j]
        if part.at_end == 0 and part.degree > 0:
            for i in range(part.inputs):
                passed = feedthrough[j * part.inputs + i]
                if driven[i] and passed != 0.0:
                    at_end = evaluate(coefficients, i * STRIDE, part.degree, end)
                    seen = held[i]
                    if place[i] == _START and rate[i] >= 0:
                        seen += length * held[rate[i]]
                    value += passed * (at_end - seen)
        values[j * STRIDE + node] = value
        values[j * STRIDE] = value


@c_function(_EXCHANGE)
def set_real(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """fmi2SetReal, of inputs at nodes."""
    part = carray(memory, 1)[0]
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
    status = 0
    if part.stepped == 0:
        status = _read(whole)
        raw = carray(at_address(part.raw), part.outputs, np.float64)
        for j in range(part.outputs):
            kept[j * STRIDE] = raw[j]
    for i in range(count):
        value[i] = kept[reference[i] - part.inputs * STRIDE]
    return types.int32(status)


@c_function(_STEP)
def do_step(memory, time, step, no_set_before):  # noqa: ANN001, ANN201 (typed by _STEP)
    """fmi2DoStep, in pieces."""
    whole = carray(memory, 1)
    part = whole[0]
    nodes = max(1, part.degree)
    _expand(whole)
    for node in range(1, nodes + 1):
        for piece in range(part.pieces):
            begin = (node - 1 + piece / part.pieces) / nodes
            end = (node - 1 + (piece + 1) / part.pieces) / nodes
            status = _hold(whole, begin, end)
            if status > LAST_GOOD:
                return types.int32(status)
            status = step_part(
                part.do_step, part.component, time + begin * step, (end - begin) * step
            )
            if status > LAST_GOOD:
                return types.int32(status)
        status = _read(whole)
        if status > LAST_GOOD:
            return types.int32(status)
        _keep(whole, node, node / nodes, step / (nodes * part.pieces))
    part.stepped = 1
    return types.int32(0)


@c_function(_STATE)
def get_state(memory, handle):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2GetFMUstate; the adapter itself has no state: a step sets all that it knows."""
    part = carray(memory, 1)[0]
    return state_call(part.get_state, part.component, handle)


@c_function(_STATE)
def set_state(memory, state):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2SetFMUstate."""
    part = carray(memory, 1)[0]
    return state_call(part.set_state, part.component, state)


@c_function(_STATE)
def free_state(memory, handle):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2FreeFMUstate."""
    part = carray(memory, 1)[0]
    return state_call(part.free_state, part.component, handle)

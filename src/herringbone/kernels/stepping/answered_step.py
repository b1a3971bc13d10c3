"""fmi2DoStep of a linear part by its answers, at a C address: no states, whatever their number.

In steps of known lengths from a known state, the outputs of a linear part are

    y_k = y0 + f_k + sum over j <= k of M_kj (u_j - u0):

f_k is the answer of the states at the start, M_kj that to the inputs held in step j.

Memory: a header [place, steps N, inputs p, outputs m, carried values q, inputs and outputs without
derivatives], then what a step may change and references name: f (N, m); the u_j - u0 that were held
(N, p); what others carry from step to step in here (q); the number of steps taken; u; y. At the
place follow the number of known lengths, the length that was asked for in vain, and the highest
order of derivatives that was given; for each step 1 if outputs were read after it; the lengths (N);
u0; y0; M (N, N, p, m): first the step j, then k - j.

Of p inputs the first are values, then follow their derivatives at the start of a step, order by
order; of m outputs the rates at its end follow the values.
"""

from numba import carray, types

from herringbone.kernels.compiling.jit import UNKNOWN_SIZE, c_function
from herringbone.kernels.fmi_calls import DISCARD, DO_STEP, OK

HEADER = 7
"""Length of the header; the first reference."""
KNOWN = 3
"""Length of what stands before the marks of what was read."""
_SAME = 1e-9
"""Relative difference of lengths that are one: rounding of times."""
_REALS = types.CPointer(types.float64)
_REFERENCES = types.CPointer(types.uint32)
_EXCHANGE = types.int32(_REALS, _REFERENCES, types.size_t, _REALS)
_DERIVATIVES = types.int32(_REALS, _REFERENCES, types.size_t, types.CPointer(types.int32), _REALS)


@c_function(DO_STEP)
def answered_step(memory, time, step_size, no_set_before):  # noqa: ANN001, ANN201 (typed by DO_STEP)
    """A step of a known length; a discarded one where the length is not known."""
    b = carray(memory, UNKNOWN_SIZE)
    at, steps, p, m = int(b[0]), int(b[1]), int(b[2]), int(b[3])
    held = HEADER + steps * m
    count = held + steps * p + int(b[4])
    u = count + 1
    y, lengths = u + p, at + KNOWN + steps
    now = int(b[count])
    known = now < int(b[at])
    if not known or abs(b[lengths + now] - step_size) > _SAME * step_size:
        b[at + 1] = step_size
        return types.int32(DISCARD)
    start = lengths + steps
    answers = start + p + m
    for i in range(p):
        b[held + now * p + i] = b[u + i] - b[start + i]
    for i in range(m):
        b[y + i] = b[start + p + i] + b[HEADER + now * m + i]
    for j in range(now + 1):
        block = answers + (j * steps + now - j) * p * m
        for i in range(p):
            value = b[held + j * p + i]
            if value != 0.0:
                for k in range(m):
                    b[y + k] += b[block + i * m + k] * value
    b[count] = now + 1
    return types.int32(OK)


@c_function(_EXCHANGE)
def read_answers(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """fmi2GetReal; after which steps it is called is kept."""
    b = carray(memory, UNKNOWN_SIZE)
    at, steps, p, m = int(b[0]), int(b[1]), int(b[2]), int(b[3])
    now = int(b[HEADER + steps * (m + p) + int(b[4])])
    if now > 0:
        b[at + KNOWN + now - 1] = 1.0
    reference, value = carray(references, UNKNOWN_SIZE), carray(values, UNKNOWN_SIZE)
    for i in range(count):
        value[i] = b[reference[i]]
    return types.int32(OK)


@c_function(_DERIVATIVES)
def set_input_derivatives(memory, references, count, orders, values):  # noqa: ANN001, ANN201
    """fmi2SetRealInputDerivatives, of the orders that there are; others are discarded."""
    b = carray(memory, UNKNOWN_SIZE)
    at, p, plain = int(b[0]), int(b[2]), int(b[5])
    reference, order = carray(references, UNKNOWN_SIZE), carray(orders, UNKNOWN_SIZE)
    value = carray(values, UNKNOWN_SIZE)
    for i in range(count):
        if order[i] < 1 or (order[i] + 1) * plain > p:
            return types.int32(DISCARD)
        b[reference[i] + order[i] * plain] = value[i]
        b[at + 2] = max(b[at + 2], order[i])
    return types.int32(OK)


@c_function(_DERIVATIVES)
def get_output_rates(memory, references, count, orders, values):  # noqa: ANN001, ANN201
    """fmi2GetRealOutputDerivatives, of the first order."""
    b = carray(memory, UNKNOWN_SIZE)
    at, steps, p, m, plain = int(b[0]), int(b[1]), int(b[2]), int(b[3]), int(b[6])
    now = int(b[HEADER + steps * (m + p) + int(b[4])])
    if now > 0:
        b[at + KNOWN + now - 1] = 1.0
    reference, value = carray(references, UNKNOWN_SIZE), carray(values, UNKNOWN_SIZE)
    for i in range(count):
        value[i] = b[reference[i] + plain]
    return types.int32(OK)

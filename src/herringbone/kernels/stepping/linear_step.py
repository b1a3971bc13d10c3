"""fmi2DoStep of a linear part, at a C address: x' = a x + b (u - u0), y = y0 + c x + d (u - u0).

Memory: a header [place, states n, inputs p, outputs m], then the values x, u, y that references
name. At the place follow the number of known lengths of a step, and the length that was asked for
in vain; u0; y0; room for n + m values; then for each known length h its [h, matrix], where the
matrix [[a, b], [c, d]] stands by rows.
"""

from numba import carray, types

from herringbone.kernels.compiling.jit import c_function
from herringbone.kernels.fmi_calls import DISCARD, DO_STEP, OK

HEADER = 4
"""Length of the header; the first reference."""
KNOWN = 2
"""Length of what stands before u0."""
_SAME = 1e-9
"""Relative difference of lengths that are one: rounding of times."""


def map_length(states: int, inputs: int, outputs: int) -> int:
    """Length of what is known for one length of a step."""
    return 1 + (states + outputs) * (states + inputs)


@c_function(DO_STEP)
def linear_step(memory, time, step_size, no_set_before):  # noqa: ANN001, ANN201 (typed by DO_STEP)
    """A step of a known length; a discarded one where the length is not known."""
    b = carray(memory, HEADER)
    at, n, p, m = int(b[0]), int(b[1]), int(b[2]), int(b[3])
    start = at + KNOWN
    room = start + p + m
    place, size = room + n + m, 1 + (n + m) * (n + p)
    for _ in range(int(b[at])):
        if abs(b[place] - step_size) <= _SAME * step_size:
            break
        place += size
    else:
        b[at + 1] = step_size
        return types.int32(DISCARD)
    for i in range(n + m):
        row = place + 1 + i * (n + p)
        value = 0.0 if i < n else b[start + p + i - n]
        for j in range(n):
            value += b[row + j] * b[HEADER + j]
        for j in range(p):
            value += b[row + n + j] * (b[HEADER + n + j] - b[start + j])
        b[room + i] = value
    for i in range(n):
        b[HEADER + i] = b[room + i]
    for i in range(m):
        b[HEADER + n + p + i] = b[room + n + i]
    return types.int32(OK)

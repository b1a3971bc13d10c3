"""fmi2DoStep of a part whose step is one affine map, at a C address.

Memory: a header [inputs, outputs, place], then the values that references name. At the place follow
the references of the inputs, their values at which the map was found, the references of the
outputs, their values there, the matrix by rows, and room for the inputs' differences.
"""

from numba import carray, types

from herringbone.kernels.compiling.jit import c_function
from herringbone.kernels.fmi_calls import DO_STEP, OK

HEADER = 3
"""Length of the header; the first reference."""


def map_length(inputs: int, outputs: int) -> int:
    """Length of what stands at the place."""
    return 3 * inputs + 2 * outputs + outputs * inputs


@c_function(DO_STEP)
def affine_step(memory, time, step_size, no_set_before):  # noqa: ANN001, ANN201 (typed by DO_STEP)
    """outputs = values there + matrix (inputs - values there)."""
    b = carray(memory, HEADER)
    inputs, outputs, at = int(b[0]), int(b[1]), int(b[2])
    there, out = at + inputs, at + 2 * inputs
    matrix = out + 2 * outputs
    difference = matrix + outputs * inputs
    for j in range(inputs):
        b[difference + j] = b[int(b[at + j])] - b[there + j]
    for i in range(outputs):
        value = b[out + outputs + i]
        row = matrix + i * inputs
        for j in range(inputs):
            value += b[row + j] * b[difference + j]
        b[int(b[out + i])] = value
    return types.int32(OK)

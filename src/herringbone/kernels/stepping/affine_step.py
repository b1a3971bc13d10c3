"""fmi2DoStep of a part whose step is one affine map, at a C address.

Memory: a header [inputs, outputs, place], then the values that references name. At the place follow
the references of the inputs, their values at which the map was found, the references of the
outputs, their values there, the matrix by columns, and room for the outputs. By columns a processor
adds to several outputs at once, to each in the order of the inputs.
"""

from numba import carray, types

from herringbone.kernels.compiling.jit import c_function, kernel
from herringbone.kernels.fmi_calls import DO_STEP, OK

HEADER = 3
"""Length of the header; the first reference."""


@kernel
def map_length(inputs: int, outputs: int) -> int:
    """Length of what stands at the place."""
    return 2 * inputs + 3 * outputs + outputs * inputs


@c_function(DO_STEP)
def affine_step(memory, time, step_size, no_set_before):  # noqa: ANN001, ANN201 (typed by DO_STEP)
    """outputs = values there + matrix (inputs - values there)."""
    header = carray(memory, HEADER)
    inputs, outputs, at = int(header[0]), int(header[1]), int(header[2])
    b = carray(memory, at + map_length(inputs, outputs))
    there, out = b[at + inputs : at + 2 * inputs], at + 2 * inputs
    matrix = out + 2 * outputs
    found = b[matrix + outputs * inputs : matrix + outputs * (inputs + 1)]
    for i in range(outputs):
        found[i] = b[out + outputs + i]
    for j in range(inputs):
        difference = b[int(b[at + j])] - there[j]
        column = b[matrix + j * outputs : matrix + (j + 1) * outputs]
        for i in range(outputs):
            found[i] += column[i] * difference
    for i in range(outputs):
        b[int(b[out + i])] = found[i]
    return types.int32(OK)

"""FMI 2.0 functions of an in-process part, at C addresses, on memory = block + work space.

They have the signatures of the FMI functions, so that the compiled loop treats an in-process part
as it treats an FMU. The component pointer is the memory's address. A saved state is an array: the
number of values that a step may change, then these values; the part provides its memory.
"""

from numba import carray, types

from herringbone.kernels.compiling.jit import UNKNOWN_SIZE, c_function, reals_at

OK, DISCARD = 0, 2
_REALS = types.CPointer(types.float64)
_REFERENCES = types.CPointer(types.uint32)
_EXCHANGE = types.int32(_REALS, _REFERENCES, types.size_t, _REALS)
_STATE = types.int32(_REALS, types.CPointer(types.int64))
_RESTORE = types.int32(_REALS, _REALS)
DO_STEP = types.int32(_REALS, types.float64, types.float64, types.int32)
"""Signature of fmi2DoStep."""


@c_function(_EXCHANGE)
def set_real(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """fmi2SetReal."""
    block = carray(memory, UNKNOWN_SIZE)
    reference, value = carray(references, UNKNOWN_SIZE), carray(values, UNKNOWN_SIZE)
    for i in range(count):
        block[reference[i]] = value[i]
    return types.int32(0)


@c_function(_EXCHANGE)
def get_real(memory, references, count, values):  # noqa: ANN001, ANN201 (typed by _EXCHANGE)
    """fmi2GetReal."""
    block = carray(memory, UNKNOWN_SIZE)
    reference, value = carray(references, UNKNOWN_SIZE), carray(values, UNKNOWN_SIZE)
    for i in range(count):
        value[i] = block[reference[i]]
    return types.int32(0)


@c_function(_STATE)
def get_state(memory, handle):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2GetFMUstate, into the memory that the handle already names."""
    block, saved = carray(memory, UNKNOWN_SIZE), carray(reals_at(handle, 0), UNKNOWN_SIZE)
    for i in range(int(saved[0])):
        saved[1 + i] = block[i]
    return types.int32(0)


@c_function(_RESTORE)
def set_state(memory, saved):  # noqa: ANN001, ANN201 (typed by _RESTORE)
    """fmi2SetFMUstate."""
    block, saved_values = carray(memory, UNKNOWN_SIZE), carray(saved, UNKNOWN_SIZE)
    for i in range(int(saved_values[0])):
        block[i] = saved_values[1 + i]
    return types.int32(0)


@c_function(_STATE)
def free_state(memory, handle):  # noqa: ANN001, ANN201 (typed by _STATE)
    """fmi2FreeFMUstate; the memory belongs to the part."""
    return types.int32(0)

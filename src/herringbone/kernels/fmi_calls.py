"""FMI 2.0 functions of an in-process part, at C addresses, on memory = block + work space.

They have the signatures of the FMI functions, so that the compiled loop treats an in-process part
as it treats an FMU. The component pointer is the memory's address. A saved state is an array: the
number of values that a step may change, then these values; the part provides its memory.
"""

from collections.abc import Callable

from numba import carray, types
from numba.core.ccallback import CFunc

from herringbone.kernels.jit import c_function, reals_at

OK, DISCARD = 0, 2
_REALS = types.CPointer(types.float64)
_REFERENCES = types.CPointer(types.uint32)
_EXCHANGE = types.int32(_REALS, _REFERENCES, types.size_t, _REALS)
_STATE = types.int32(_REALS, types.CPointer(types.int64))
_RESTORE = types.int32(_REALS, _REALS)
_DO_STEP = types.int32(_REALS, types.float64, types.float64, types.int32)
_UNKNOWN_SIZE = 1  # bounds are not checked


def _set_real(memory, references, count, values):  # noqa: ANN001, ANN202 (typed by _EXCHANGE)
    block = carray(memory, _UNKNOWN_SIZE)
    reference, value = carray(references, _UNKNOWN_SIZE), carray(values, _UNKNOWN_SIZE)
    for i in range(count):
        block[reference[i]] = value[i]
    return types.int32(0)


def _get_real(memory, references, count, values):  # noqa: ANN001, ANN202 (typed by _EXCHANGE)
    block = carray(memory, _UNKNOWN_SIZE)
    reference, value = carray(references, _UNKNOWN_SIZE), carray(values, _UNKNOWN_SIZE)
    for i in range(count):
        value[i] = block[reference[i]]
    return types.int32(0)


def _get_state(memory, handle):  # noqa: ANN001, ANN202 (typed by _STATE)
    block, saved = carray(memory, _UNKNOWN_SIZE), carray(reals_at(handle, 0), _UNKNOWN_SIZE)
    for i in range(int(saved[0])):
        saved[1 + i] = block[i]
    return types.int32(0)


def _set_state(memory, saved):  # noqa: ANN001, ANN202 (typed by _RESTORE)
    block, saved_values = carray(memory, _UNKNOWN_SIZE), carray(saved, _UNKNOWN_SIZE)
    for i in range(int(saved_values[0])):
        block[i] = saved_values[1 + i]
    return types.int32(0)


def _free_state(_memory, _handle):  # noqa: ANN001, ANN202 (typed by _STATE)
    return types.int32(0)


set_real = c_function(_EXCHANGE, _set_real)
get_real = c_function(_EXCHANGE, _get_real)
get_state = c_function(_STATE, _get_state)
set_state = c_function(_RESTORE, _set_state)
free_state = c_function(_STATE, _free_state)


def do_step(step: Callable, block_size: int, work_size: int) -> CFunc:
    """fmi2DoStep of a component whose kernel is `step`; a failed step is a discarded one."""

    def _do_step(memory, time, step_size, _no_set_before):  # noqa: ANN001, ANN202
        whole = carray(memory, block_size + work_size)
        if step(whole[:block_size], whole[block_size:], time, step_size) == OK:
            return types.int32(OK)
        return types.int32(DISCARD)

    return c_function(_DO_STEP, _do_step)

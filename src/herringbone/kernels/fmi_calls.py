"""FMI 2.0 functions of an in-process part, at C addresses, on memory = block + work space.

They have the signatures of fmi2SetReal, fmi2GetReal and fmi2DoStep, so that the compiled loop
treats an in-process part as it treats an FMU. The component pointer is the memory's address.
"""

from collections.abc import Callable

from numba import carray, types
from numba.core.ccallback import CFunc

from herringbone.kernels.jit import c_function

OK, DISCARD = 0, 2
_REALS = types.CPointer(types.float64)
_REFERENCES = types.CPointer(types.uint32)
_EXCHANGE = types.int32(_REALS, _REFERENCES, types.size_t, _REALS)
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


set_real = c_function(_EXCHANGE, _set_real)
get_real = c_function(_EXCHANGE, _get_real)


def do_step(step: Callable, block_size: int, work_size: int) -> CFunc:
    """fmi2DoStep of a component whose kernel is `step`; a failed step is a discarded one."""

    def _do_step(memory, time, step_size, _no_set_before):  # noqa: ANN001, ANN202
        whole = carray(memory, block_size + work_size)
        if step(whole[:block_size], whole[block_size:], time, step_size) == OK:
            return types.int32(OK)
        return types.int32(DISCARD)

    return c_function(_DO_STEP, _do_step)

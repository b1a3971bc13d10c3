"""Kernels as constants of other kernels: they are called by name, and need no address.

numba writes the address of the Python object beside each call, though nobody reads it; code with an
address of this process in it cannot be kept.

What it leans on inside of numba is tested for every minor version that is admitted.
"""

from llvmlite import ir
from numba import types
from numba.core.base import BaseContext
from numba.core.imputils import lower_constant
from numba.experimental.function_type import lower_constant_dispatcher

from herringbone.kernels.compiling.dispatching import KernelDispatcher


@lower_constant(types.Dispatcher)
def constant(
    context: BaseContext, builder: ir.IRBuilder, kind: types.Type, value: object
) -> ir.Value:
    """The dispatcher of a kernel, or one of numba."""
    if isinstance(value, KernelDispatcher):
        return ir.Constant(context.get_value_type(types.voidptr), None)
    return lower_constant_dispatcher(context, builder, kind, value)

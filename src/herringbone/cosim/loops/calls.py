"""Calling C functions by their address from compiled code.

Those of FMUs leave rounding and flushing to zero as they were for whoever calls them.
"""

from collections.abc import Callable

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from herringbone.cosim.loops.float_modes import keep_modes
from herringbone.kernels.compiling.jit import kernel

_INT32 = ir.IntType(32)
_GIVEN = {
    "address": types.int64, "count": types.int64, "real": types.float64, "flag": types.int32
}  # fmt: skip


def c_call(*kinds: str) -> Callable:
    """An intrinsic (address, *arguments) -> int32 that calls the C function at an address.

    Args:
        kinds: of the function's arguments: "address" (a pointer, given as int64), "count" (int64),
            "real" (float64) or "flag" (int32).
    """

    @intrinsic
    def call(typing_context, target, arguments):  # noqa: ANN001, ANN202
        signature = types.int32(types.int64, types.Tuple([_GIVEN[kind] for kind in kinds]))

        def generate(context, builder, signature, given):  # noqa: ANN001, ANN202
            values = cgutils.unpack_tuple(builder, given[1], len(kinds))
            passed = [
                builder.inttoptr(v, cgutils.voidptr_t) if kind == "address" else v
                for kind, v in zip(kinds, values, strict=True)
            ]
            function = ir.FunctionType(_INT32, [v.type for v in passed])
            return builder.call(builder.inttoptr(given[0], function.as_pointer()), passed)

        return signature, generate

    return call


@intrinsic
def at_address(typing_context, address):  # noqa: ANN001, ANN201
    """Pointer to what stands at an address."""

    def generate(context, builder, signature, arguments):  # noqa: ANN001, ANN202
        return builder.inttoptr(arguments[0], cgutils.voidptr_t)

    return types.voidptr(types.int64), generate


set_or_get = c_call("address", "address", "count", "address")
"""fmi2SetReal or fmi2GetReal."""
set_or_get_derivatives = c_call("address", "address", "count", "address", "address")
"""fmi2SetRealInputDerivatives or fmi2GetRealOutputDerivatives."""
step_once = c_call("address", "real", "real", "flag")
"""fmi2DoStep."""
of_state = c_call("address", "address")
"""fmi2GetFMUstate, fmi2SetFMUstate or fmi2FreeFMUstate."""


@kernel
def exchange_reals(address: int, component: int, references: int, count: int, values: int) -> int:
    """fmi2SetReal or fmi2GetReal at `address`; the others are addresses too. FMI status."""
    status = set_or_get(address, (component, references, count, values))
    keep_modes()
    return status


@kernel
def exchange_derivatives(
    address: int, component: int, references: int, count: int, orders: int, values: int
) -> int:
    """fmi2SetRealInputDerivatives or fmi2GetRealOutputDerivatives at `address`. FMI status."""
    status = set_or_get_derivatives(address, (component, references, count, orders, values))
    keep_modes()
    return status


@kernel
def do_step(address: int, component: int, time: float, step: float) -> int:
    """fmi2DoStep at `address`, with noSetFMUStatePriorToCurrentPoint true. FMI status."""
    status = step_once(address, (component, time, step, np.int32(1)))
    keep_modes()
    return status


@kernel
def state_call(address: int, component: int, state: int) -> int:
    """Get or free an FMU state (`state`: address of its handle), or set it (the handle). Status."""
    status = of_state(address, (component, state))
    keep_modes()
    return status

"""Calling C functions by their address from compiled code."""

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from herringbone.kernels.jit import kernel

_INT32, _INT64, _DOUBLE = ir.IntType(32), ir.IntType(64), ir.DoubleType()


@intrinsic
def _exchange(typing_context, address, component, references, count, values):  # noqa: ANN001, ANN202
    signature = types.int32(*[types.int64] * 5)

    def generate(context, builder, signature, arguments):  # noqa: ANN001, ANN202
        pointer = cgutils.voidptr_t
        kind = ir.FunctionType(_INT32, [pointer, pointer, _INT64, pointer])
        target, component, references, count, values = arguments
        return builder.call(
            builder.inttoptr(target, kind.as_pointer()),
            [
                builder.inttoptr(component, pointer),
                builder.inttoptr(references, pointer),
                count,
                builder.inttoptr(values, pointer),
            ],
        )

    return signature, generate


@intrinsic
def _derivatives(typing_context, address, component, references, count, orders, values):  # noqa: ANN001, ANN202
    signature = types.int32(*[types.int64] * 6)

    def generate(context, builder, signature, arguments):  # noqa: ANN001, ANN202
        pointer = cgutils.voidptr_t
        kind = ir.FunctionType(_INT32, [pointer, pointer, _INT64, pointer, pointer])
        target, component, references, count, orders, values = arguments
        return builder.call(
            builder.inttoptr(target, kind.as_pointer()),
            [
                builder.inttoptr(component, pointer),
                builder.inttoptr(references, pointer),
                count,
                builder.inttoptr(orders, pointer),
                builder.inttoptr(values, pointer),
            ],
        )

    return signature, generate


@intrinsic
def _step(typing_context, address, component, time, step):  # noqa: ANN001, ANN202
    signature = types.int32(types.int64, types.int64, types.float64, types.float64)

    def generate(context, builder, signature, arguments):  # noqa: ANN001, ANN202
        pointer = cgutils.voidptr_t
        kind = ir.FunctionType(_INT32, [pointer, _DOUBLE, _DOUBLE, _INT32])
        target, component, time, step = arguments
        return builder.call(
            builder.inttoptr(target, kind.as_pointer()),
            [builder.inttoptr(component, pointer), time, step, _INT32(1)],
        )

    return signature, generate


@intrinsic
def _state(typing_context, address, component, state):  # noqa: ANN001, ANN202
    signature = types.int32(types.int64, types.int64, types.int64)

    def generate(context, builder, signature, arguments):  # noqa: ANN001, ANN202
        pointer = cgutils.voidptr_t
        kind = ir.FunctionType(_INT32, [pointer, pointer])
        target, component, state = arguments
        return builder.call(
            builder.inttoptr(target, kind.as_pointer()),
            [builder.inttoptr(component, pointer), builder.inttoptr(state, pointer)],
        )

    return signature, generate


@kernel
def exchange_reals(address: int, component: int, references: int, count: int, values: int) -> int:
    """fmi2SetReal or fmi2GetReal at `address`; the others are addresses too. FMI status."""
    return _exchange(address, component, references, count, values)


@kernel
def exchange_derivatives(
    address: int, component: int, references: int, count: int, orders: int, values: int
) -> int:
    """fmi2SetRealInputDerivatives or fmi2GetRealOutputDerivatives at `address`. FMI status."""
    return _derivatives(address, component, references, count, orders, values)


@kernel
def do_step(address: int, component: int, time: float, step: float) -> int:
    """fmi2DoStep at `address`, with noSetFMUStatePriorToCurrentPoint true. FMI status."""
    return _step(address, component, time, step)


@kernel
def state_call(address: int, component: int, state: int) -> int:
    """Get or free an FMU state (`state`: address of its handle), or set it (the handle). Status."""
    return _state(address, component, state)

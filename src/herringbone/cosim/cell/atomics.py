"""Words of memory that two processes share: atomic access, and sleeping until one changes."""

import platform

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from herringbone.cosim.cell.system_calls import FUTEX, GETPPID
from herringbone.cosim.loops.calls import c_call
from herringbone.kernels.compiling.jit import kernel

_INT32 = ir.IntType(32)
_ALIGNED = 4
_PAUSE = {"x86_64": "llvm.x86.sse2.pause"}.get(platform.machine(), "")
_WAIT, _WAKE, _ALL = 0, 1, 2**31 - 1

_syscall = c_call("count", "address", "count", "count", "address", "address", "count")


@intrinsic
def load_acquire(typing_context, address):  # noqa: ANN001, ANN201
    """The int32 at an address; what was written before it was stored is seen after this."""

    def generate(context, builder, signature, arguments):  # noqa: ANN001, ANN202
        pointer = builder.inttoptr(arguments[0], _INT32.as_pointer())
        return builder.load_atomic(pointer, "acquire", _ALIGNED)

    return types.int32(types.int64), generate


@intrinsic
def store_release(typing_context, address, value):  # noqa: ANN001, ANN201
    """Store an int32 at an address; whoever loads it sees what was written before."""

    def generate(context, builder, signature, arguments):  # noqa: ANN001, ANN202
        pointer = builder.inttoptr(arguments[0], _INT32.as_pointer())
        builder.store_atomic(arguments[1], pointer, "release", _ALIGNED)
        return context.get_dummy_value()

    return types.void(types.int64, types.int32), generate


@intrinsic
def fence(typing_context):  # noqa: ANN001, ANN201
    """Full barrier: a store before it is seen by others before a load after it is made."""

    def generate(context, builder, signature, arguments):  # noqa: ANN001, ANN202
        builder.fence("seq_cst")
        return context.get_dummy_value()

    return types.void(), generate


@intrinsic
def pause(typing_context):  # noqa: ANN001, ANN201
    """Tell the processor that this is a loop that waits."""

    def generate(context, builder, signature, arguments):  # noqa: ANN001, ANN202
        if _PAUSE:
            kind = ir.FunctionType(ir.VoidType(), [])
            builder.call(cgutils.get_or_insert_function(builder.module, kind, _PAUSE), [])
        return context.get_dummy_value()

    return types.void(), generate


@kernel
def sleep_while(syscall: int, word: int, value: int, timeout: int) -> None:
    """Sleep while the int32 at `word` has a value, at most for the timespec at `timeout`."""
    _syscall(syscall, (FUTEX, word, _WAIT, np.int64(value), timeout, np.int64(0), np.int64(0)))


@kernel
def wake(syscall: int, word: int) -> None:
    """Wake whoever sleeps on the int32 at `word`."""
    _syscall(syscall, (FUTEX, word, _WAKE, _ALL, np.int64(0), np.int64(0), np.int64(0)))


@kernel
def parent(syscall: int) -> int:
    """Number of this process' parent."""
    zero = np.int64(0)
    return _syscall(syscall, (GETPPID, zero, zero, zero, zero, zero, zero))

"""Rounding and flushing to zero, which a call of an FMU may change for the whole thread."""

import platform
import sys

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

_ON_X86 = platform.machine() in {"x86_64", "AMD64"}
_MODES, _DEFAULT, _TO_NEAREST = 0xFFC0, 0x1F80, 0
"""Of the register MXCSR: rounding, masks of exceptions, denormal numbers; all but the flags."""


@intrinsic
def keep_modes(typing_context):  # noqa: ANN001, ANN201
    """Set back what is not the default; on other processors than x86 nothing."""

    def generate(context, builder, signature, arguments):  # noqa: ANN001, ANN202
        if not _ON_X86:
            return context.get_dummy_value()
        word, pointer = ir.IntType(32), cgutils.voidptr_t
        kind = ir.FunctionType(ir.VoidType(), [pointer])
        read, write = (
            cgutils.get_or_insert_function(builder.module, kind, f"llvm.x86.sse.{name}")
            for name in ("stmxcsr", "ldmxcsr")
        )
        place = cgutils.alloca_once(builder, word)
        at = builder.bitcast(place, pointer)
        builder.call(read, [at])
        modes = builder.and_(builder.load(place), word(_MODES))
        with builder.if_then(builder.icmp_unsigned("!=", modes, word(_DEFAULT)), likely=False):
            builder.store(word(_DEFAULT), place)
            builder.call(write, [at])
            if sys.platform == "linux":  # the older unit of the processor rounds by itself
                kind = ir.FunctionType(word, [word])
                rounding = cgutils.get_or_insert_function(builder.module, kind, "fesetround")
                builder.call(rounding, [word(_TO_NEAREST)])
        return context.get_dummy_value()

    return types.void(), generate

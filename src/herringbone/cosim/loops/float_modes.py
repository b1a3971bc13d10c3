"""Rounding and flushing to zero, which a call of an FMU may change for the whole thread."""

import platform
import sys

from llvmlite import binding, ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

_ON_X86 = platform.machine() in {"x86_64", "AMD64"}
_MODES, _DEFAULT = 0xFFC0, 0x1F80
"""Of the register MXCSR: rounding, masks of exceptions, denormal numbers; all but the flags."""
_OLD_MODES, _OLD_DEFAULT = 0x0F3F, 0x037F
"""Of the control word of the older unit, x87: rounding, precision, masks; as Linux begins."""

if _ON_X86:
    binding.initialize_native_asmparser()


def _instruction(builder: ir.IRBuilder, text: str, place: ir.Value) -> None:
    """An instruction that reads or writes what stands at an address."""
    kind = ir.FunctionType(ir.VoidType(), [place.type])
    builder.asm(kind, text, "r,~{memory},~{dirflag},~{fpsr},~{flags}", [place], side_effect=True)


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
        if sys.platform == "linux":
            _keep_old_modes(builder)
        return context.get_dummy_value()

    return types.void(), generate


def _keep_old_modes(builder: ir.IRBuilder) -> None:
    """The older unit rounds by itself: long doubles of C, and what C libraries make of them."""
    word = ir.IntType(16)
    place = cgutils.alloca_once(builder, word)
    at = builder.bitcast(place, cgutils.voidptr_t)
    _instruction(builder, "fnstcw ($0)", at)
    modes = builder.and_(builder.load(place), word(_OLD_MODES))
    default = word(_OLD_DEFAULT & _OLD_MODES)
    with builder.if_then(builder.icmp_unsigned("!=", modes, default), likely=False):
        builder.store(word(_OLD_DEFAULT), place)
        _instruction(builder, "fldcw ($0)", at)

"""Who compiles a kernel when it is called: a whole for Python and C, a piece for other kernels."""

from collections.abc import Callable
from functools import cached_property

import llvmlite.binding as llvm
from numba import types
from numba.core import compiler
from numba.core.ccallback import CFunc
from numba.core.compiler import CompileResult
from numba.core.dispatcher import _FunctionCompiler
from numba.core.registry import CPUDispatcher
from numba.core.typing import Signature

from herringbone.core.process.activity import COMPILING
from herringbone.kernels.compiling.linking import LINKED, PIECE, WHOLE, quickly


class _Flags(compiler.Flags):
    """numba's, compared by what is set: numba compares all fifty with each lookup in its caches."""

    __slots__ = ()
    __hash__ = compiler.Flags.__hash__

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Flags) and self._values == other._values


def entry_name() -> Callable:
    """A built-in function of its own, by which callers find the code of a piece."""
    own: list[None] = []
    return own.count


class _PieceCompiler(_FunctionCompiler):
    """numba's, without wrappers and without an environment: a piece is not called from Python."""

    def _customize_flags(self, flags: compiler.Flags) -> compiler.Flags:
        flags = _Flags(flags)
        flags.no_cpython_wrapper = flags.no_cfunc_wrapper = flags.no_compile = True
        return flags

    def _compile_core(self, args: tuple, return_type: types.Type | None) -> CompileResult:
        found = super()._compile_core(args, return_type)
        name = entry_name()
        self.targetdescr.target_context.insert_user_function(name, found.fndesc, [found.library])
        return found._replace(entry_point=name)


class _PieceDispatcher(CPUDispatcher):
    """Compiles pieces."""

    def __init__(self, py_func, locals=None, targetoptions=None, pipeline_class=PIECE) -> None:  # noqa: ANN001
        super().__init__(py_func, locals, targetoptions, pipeline_class)
        self._compiler = _PieceCompiler(
            py_func, self.targetdescr, self.targetoptions, self.locals, pipeline_class
        )


class _WholeCompiler(_FunctionCompiler):
    """numba's, which says that it compiles if this takes long."""

    def compile(self, args: tuple, return_type: types.Type | None) -> tuple:
        with COMPILING.piece():
            return super().compile(args, return_type)


class KernelDispatcher(CPUDispatcher):
    """Compiles a whole when it is called from Python, and gives pieces to other kernels."""

    cache_of_pieces: Callable[[Callable], object] | None = None
    """Makes the cache of its pieces; None if they are not kept."""

    def __init__(self, py_func, targetoptions, pipeline_class=WHOLE, piece_class=PIECE) -> None:  # noqa: ANN001
        super().__init__(py_func, {}, {**targetoptions, "no_cfunc_wrapper": True}, pipeline_class)
        self._piece_class = piece_class
        self._compiler = _WholeCompiler(
            py_func, self.targetdescr, self.targetoptions, self.locals, pipeline_class
        )

    @cached_property
    def piece(self) -> _PieceDispatcher:
        """Gives pieces to other kernels."""
        found = _PieceDispatcher(self.py_func, {}, self.targetoptions, self._piece_class)
        if self.cache_of_pieces is not None:
            found._cache = self.cache_of_pieces(self.py_func)
        return found

    def compile(self, sig: Signature | tuple) -> Callable:
        """Compile for a signature, unless it is compiled or cached."""
        with quickly():
            return super().compile(sig)

    def get_call_template(self, args: tuple, kws: dict) -> tuple:
        """For calls from other kernels: those of the piece.

        It is compiled once, not for each constant that it is called with; LLVM sees these where it
        takes the piece into its caller.
        """
        return self.piece.get_call_template(tuple(map(types.unliteral, args)), kws)

    def get_overload(self, sig: Signature) -> object:
        """What other kernels find the code by."""
        return self.piece.get_overload(sig)


class CFunction(CFunc):
    """A function that is called by its C address, compiled when this is asked for."""

    def compile(self) -> None:
        """Compile it, unless it is cached."""
        with quickly():
            super().compile()

    def _compile_uncached(self) -> CompileResult:
        if self._compiler.pipeline_class is LINKED:  # whoever builds something of it says so
            return super()._compile_uncached()
        with COMPILING.piece():
            return super()._compile_uncached()

    @property
    def address(self) -> int:
        """The C address."""
        if self._wrapper_address is None:
            self.compile()
        return self._wrapper_address

    @property
    def code(self) -> llvm.ModuleRef:
        """Its LLVM code; what it reaches is in it if it is made with `LINKED`."""
        return self._library._final_module

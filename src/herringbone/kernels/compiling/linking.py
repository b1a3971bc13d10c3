"""How kernels become machine code: each is optimised once, in whoever is called from outside.

numba optimises a function and makes machine code of it, then does so again with every caller that
contains it; in a deep call tree that takes most of the time of a first run. Here a kernel that is
called by other kernels is a `Piece`: LLVM code as numba writes it, made shorter (see
`simplifying`), which the cache keeps (see `kept_pieces`). Whoever is called from Python or through
a C address is a `Whole`: it takes in all pieces that it reaches, makes them its own, and is
optimised once.

No piece can be seen from outside of its whole. numba tells closures of one factory apart by a
counter of the process, so that pieces of the same name in callers that different processes cached
may differ; seen from outside, the first one to be loaded would take the place of all.

What it leans on inside of numba is tested for every minor version that is admitted.
"""

import gc
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import cached_property
from types import MappingProxyType

import llvmlite.binding as llvm
from numba import types
from numba.core import compiler
from numba.core.ccallback import CFunc
from numba.core.codegen import CodeLibrary, JITCodeLibrary
from numba.core.compiler import CompileResult
from numba.core.dispatcher import _FunctionCompiler
from numba.core.registry import CPUDispatcher
from numba.core.typed_passes import InlineOverloads, NopythonRewrites
from numba.core.typing import Signature
from numba.core.untyped_passes import (
    InlineClosureLikes,
    LiteralPropagationSubPipelinePass,
    LiteralUnroll,
)

from herringbone.core.activity import COMPILING
from herringbone.kernels.compiling.pieces import Hot, Piece, Rare, callers_first, is_global
from herringbone.kernels.compiling.quiet import quiet
from herringbone.kernels.compiling.typed_calls import remembered_calls

_NEEDLESS = {
    NopythonRewrites,
    InlineOverloads,
    InlineClosureLikes,
    LiteralUnroll,
    LiteralPropagationSubPipelinePass,
}
"""Passes of numba for what the kernel language does not have: array expressions, functions inside
of functions, functions that are inlined before they are typed, loops over tuples of several types.
"""
_SHARED = llvm.Linkage.linkonce_odr


@contextmanager
def quickly() -> Iterator[None]:
    """Without the search for cycles among millions of objects, a sixth of the time.

    Only the outermost one turns it on again, after which all that it made is searched: who compiles
    much at once does so inside of one.
    """
    collects = gc.isenabled()
    gc.disable()
    try:
        with remembered_calls(), quiet():
            yield
    finally:
        if collects:
            gc.enable()


class Whole(JITCodeLibrary):
    """Machine code of a function that is called from outside, with all pieces that it reaches."""

    _tuning: Mapping[str, object] = MappingProxyType({})
    _linking_libraries: list[CodeLibrary]

    def finalize(self) -> None:
        """Take in all libraries that are called, and those that they need."""
        self._linking_libraries = callers_first(self._linking_libraries)
        super().finalize()

    def _optimize_functions(self, ll_module: llvm.ModuleRef) -> None:
        ll_module.data_layout = self._codegen._data_layout

    def _make_own(self) -> None:
        for function in self._final_module.functions:
            if not function.is_declaration and function.linkage == _SHARED:
                function.linkage = "internal"

    def _optimize_final_module(self) -> None:
        """Once: numba's round before it serves counted references, and hardly a kernel has any."""
        self._make_own()
        passes, builder = self._codegen._module_pass_manager(**self._tuning)
        passes.run(self._final_module, builder)


class Quick(Whole):
    """As `Whole`, made quickly: for what runs a few times.

    Pieces are machine code as they are, in half of the time that the least optimisation takes.
    """

    _tuning = MappingProxyType({"loop_vectorize": False, "slp_vectorize": False, "opt": 0})


class Linked(Whole):
    """As `Whole`, but neither optimised nor compiled: for another target."""

    def _optimize_final_module(self) -> None:
        pass

    def _finalize_final_module(self) -> None:
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """No address: there is no machine code."""
        del name
        self._ensure_finalized()
        return 0


def _pipeline(library_class: type[JITCodeLibrary]) -> type[compiler.Compiler]:
    """numba's compiler, with another kind of library."""

    class Pipeline(compiler.Compiler):
        def define_pipelines(self) -> list:
            function = self.state.func_id
            codegen, name = self.state.targetctx.codegen(), function.func_qualname
            if issubclass(library_class, Piece) and is_global(function.func):
                function.unique_name, function.unique_id = name, None  # the same in all processes
            self.state.library = library_class(codegen, name)
            self.state.library.enable_object_caching()
            (passes,) = super().define_pipelines()
            passes.passes = [each for each in passes.passes if each[0] not in _NEEDLESS]
            passes.finalize()
            return [passes]

    return Pipeline


PIECE, RARE, HOT, WHOLE, QUICK, LINKED = map(_pipeline, (Piece, Rare, Hot, Whole, Quick, Linked))


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

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
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from types import MappingProxyType

import llvmlite.binding as llvm
from numba.core import compiler
from numba.core.codegen import CodeLibrary, JITCodeLibrary
from numba.core.typed_passes import InlineOverloads, NopythonRewrites
from numba.core.untyped_passes import (
    InlineClosureLikes,
    LiteralPropagationSubPipelinePass,
    LiteralUnroll,
)

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

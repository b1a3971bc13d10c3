"""Pieces of kernels in the cache, for whatever else is compiled of them.

Systems, their tangents and their loops are made of the same kernels, in many processes. To type a
kernel and to write it as LLVM code takes numba some fifty milliseconds, to read it again two.

A kept piece names the pieces that it calls. They are read, or compiled, with it, and it serves if
they still return what they did. Kernels that factories make are not kept, nor is who calls them:
what is in them does not follow from the sources alone.

What it leans on inside of numba is tested for every minor version that is admitted.
"""

from collections.abc import Callable
from typing import NamedTuple
from weakref import WeakValueDictionary

import llvmlite.binding as llvm
from numba import types
from numba.core.compiler import CompileResult, compile_result
from numba.core.cpu import CPUContext
from numba.core.funcdesc import FunctionDescriptor
from numba.core.typing import Signature

from herringbone.kernels.compiling.cache import KernelCache, KernelFiles, cached
from herringbone.kernels.compiling.dispatching import KernelDispatcher, entry_name
from herringbone.kernels.compiling.pieces import Known, Piece, is_global

_kernels: "WeakValueDictionary[tuple[str, str], KernelDispatcher]" = WeakValueDictionary()
"""Those whose pieces may be kept, by module and name."""


class _Called(NamedTuple):
    """A piece that another one calls."""

    module: str
    name: str
    arguments: tuple[types.Type, ...]
    returned: types.Type

    def library(self) -> Piece | None:
        """The piece, read or compiled; None if it is another one now."""
        kernel = _kernels.get((self.module, self.name))
        if kernel is None:
            return None
        kernel.piece.compile(self.arguments)
        found = kernel.piece.overloads[self.arguments]
        return found.library if found.signature.return_type == self.returned else None


class _Kept(NamedTuple):
    """What the cache has of a piece."""

    code: bytes
    described: FunctionDescriptor
    signature: Signature
    calls: tuple[Known, ...]


class _PieceFiles(KernelFiles):
    """Pieces as they are kept."""

    def get_filename_base(self, fullname: str, abiflags: str) -> str:
        """As of the kernel's own code, with another end."""
        return f"{super().get_filename_base(fullname, abiflags)}.piece"

    def check_cachable(self, found: CompileResult) -> bool:
        """True if it can be kept, and all that it calls."""
        library, described = found.library, found.fndesc
        if described.global_dict is not None or library.has_dynamic_globals:
            return False
        if None in library.linked:
            return False
        library.known_as = _name_of(found)
        return True

    def reduce(self, found: CompileResult) -> _Kept:
        """What is kept of a piece."""
        described, library = found.fndesc, found.library
        described.typemap = described.calltypes = None
        calls = tuple(library.linked)
        return _Kept(library.code.as_bitcode(), described, found.signature, calls)

    def rebuild(self, target_context: CPUContext, kept: _Kept) -> CompileResult | None:
        """A piece that was kept; None if what it calls has changed."""
        libraries = [called.library() for called in kept.calls]
        if None in libraries:
            return None
        described, code = kept.described, llvm.parse_bitcode(kept.code)
        library = Piece.of(target_context.codegen(), described.qualname, code, libraries)
        found = compile_result(
            typing_context=target_context.typing_context,
            target_context=target_context,
            entry_point=entry_name(),
            fndesc=described,
            signature=kept.signature,
            library=library,
            objectmode=False,
        )
        library.known_as = _name_of(found)
        return found


def _name_of(found: CompileResult) -> _Called:
    described, signature = found.fndesc, found.signature
    return _Called(described.modname, described.qualname, signature.args, signature.return_type)


class PieceCache(KernelCache):
    """The cache of a kernel's pieces."""

    _impl_class = _PieceFiles


def kept(kernel: KernelDispatcher, function: Callable) -> KernelDispatcher:
    """Let a kernel keep its code, and its pieces."""
    if is_global(function):
        _kernels[function.__module__, function.__qualname__] = kernel
        kernel.cache_of_pieces = PieceCache
    return cached(kernel, function)

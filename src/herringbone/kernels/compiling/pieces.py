"""LLVM code of kernels that other kernels call: made shorter, not linked with what they call.

Where a kernel takes `min`, `int` or a power, numba calls a function of its own, which it tells from
others of the same name by a counter of the process. A piece gets a copy of it, named by what is in
it, and calls other pieces by module, name and types: these names mean the same in all processes.

What it leans on inside of numba is tested for every minor version that is admitted.
"""

from collections.abc import Callable, Iterable
from typing import NamedTuple, Protocol
from weakref import WeakKeyDictionary

import llvmlite.binding as llvm
from numba.core.codegen import Codegen, CodeLibrary, JITCodeLibrary
from numba.core.registry import cpu_target
from numba.core.runtime import rtsys

from herringbone.core.caching.keys import digest_of
from herringbone.kernels.compiling.simplifying import simplify

_ANY = "own"


def is_global(function: Callable) -> bool:
    """True if a function is the only one of its module that has its name."""
    return "<locals>" not in function.__qualname__


class Known(Protocol):
    """What a library is found by in all processes; it can be pickled."""

    def library(self) -> CodeLibrary | None:
        """The library; None if it is another one now."""


class Runtime(NamedTuple):
    """numba's runtime, which is linked with everything."""

    def library(self) -> CodeLibrary:
        """The library."""
        return rtsys.library


class Copy(NamedTuple):
    """A copy of a function of numba.

    Attributes:
        name: follows from its content.
        code: LLVM bitcode.
    """

    name: str
    code: bytes

    def library(self) -> "Piece":
        """The copy as a piece."""
        if self.name not in _copies:
            code = llvm.parse_bitcode(self.code)
            piece = Piece.of(cpu_target.target_context.codegen(), self.name, code, ())
            piece.known_as = self
            _copies[self.name] = piece
        return _copies[self.name]


_copies: dict[str, "Piece"] = {}
_copied: WeakKeyDictionary[CodeLibrary, dict[int, tuple[Copy, dict[str, str]]]] = (
    WeakKeyDictionary()
)


class Piece(JITCodeLibrary):
    """LLVM code of one kernel."""

    known_as: Known | None = None
    """None if it is not kept."""
    _marks: tuple[str, ...] = ()
    """Attributes of its functions for LLVM."""
    _linking_libraries: list[CodeLibrary]

    @classmethod
    def of(
        cls, codegen: Codegen, name: str, code: llvm.ModuleRef, linked: Iterable[CodeLibrary]
    ) -> "Piece":
        """The piece that has some code."""
        piece = cls(codegen, name)
        piece._final_module, piece._linking_libraries = code, list(linked)
        piece._finalized = True
        return piece

    @property
    def code(self) -> llvm.ModuleRef:
        """Its own LLVM code."""
        return self._final_module

    @property
    def linked(self) -> list[Known | None]:
        """The libraries that it calls."""
        return [
            Runtime() if library is rtsys.library else library.known_as
            for library in self._linking_libraries
        ]

    def _optimize_functions(self, ll_module: llvm.ModuleRef) -> None:
        ll_module.data_layout = self._codegen._data_layout
        for function in ll_module.functions:
            if not function.is_declaration:
                simplify(function)
                for mark in self._marks:
                    function.add_function_attribute(mark)

    def finalize(self) -> None:
        """Nothing more is added; callers link it, for which numba would copy it once more."""
        self._raise_if_finalized()
        self._finalize_dynamic_globals()
        for function in self._final_module.functions:
            if not function.is_declaration and function.linkage == llvm.Linkage.external:
                function.linkage = "linkonce_odr"
        self._linking_libraries = [self._called(x) for x in dict.fromkeys(self._linking_libraries)]
        self._finalized = True

    def _called(self, library: CodeLibrary) -> CodeLibrary:
        """A library that it calls, or the copy that it calls instead."""
        if isinstance(library, Piece) or library is rtsys.library:
            return library
        declared = {function.name for function in self._final_module.functions}
        number = 0  # numba makes some functions twice: LLVM would call the second one otherwise
        copy, names = _copy_of(library, number)
        while not declared.isdisjoint(names.values()):
            number += 1
            copy, names = _copy_of(library, number)
        for function in self._final_module.functions:
            if function.name in names:
                function.name = names[function.name]
        return copy.library()

    def get_pointer_to_function(self, name: str) -> int:
        """No address: there is no machine code."""
        del name
        self._ensure_finalized()
        return 0

    @property
    def called(self) -> list[CodeLibrary]:
        """The libraries that it calls, or called before it was made shorter."""
        return self._linking_libraries


class Rare(Piece):
    """As `Piece`, for what seldom happens in a kernel that often runs: it stays outside."""

    _marks = "noinline", "cold"


class Hot(Piece):
    """As `Piece`, for products of matrices: native FMUs have it for wide vectors, too."""

    _marks = ("hot",)


def callers_first(libraries: Iterable[CodeLibrary]) -> list[CodeLibrary]:
    """Libraries and all that they need, each behind all that call it.

    Of a library LLVM takes in what is called so far. A piece may have lost its calls of another one
    when it was made shorter: by that piece alone, the other one would come in too early, and empty.
    """
    found: dict[CodeLibrary, None] = {}

    def visit(library: CodeLibrary) -> None:
        if library not in found:
            for called in reversed(library.called if isinstance(library, Piece) else []):
                visit(called)
            found[library] = None

    for library in reversed([*libraries]):
        visit(library)
    return [*reversed(found)]


def _copy_of(library: CodeLibrary, number: int) -> tuple[Copy, dict[str, str]]:
    """A copy of a library of numba, and the new names of its functions by the old ones."""
    known = _copied.setdefault(library, {})
    if number not in known:
        known[number] = _copied_anew(library, number)
    return known[number]


def _copied_anew(library: CodeLibrary, number: int) -> tuple[Copy, dict[str, str]]:
    code = library._get_module_for_linking().clone()
    functions = [f for f in code.functions if not f.is_declaration]
    old = [f.name for f in functions]
    for place, item in enumerate([*functions, *code.global_variables]):
        item.name = f"{_ANY}.{place}"
    name = f"{library.name}.{digest_of(str(code))}.{number}"
    for place, function in enumerate(functions):
        function.name = f"{name}.{place}"
    for variable in code.global_variables:
        variable.linkage = "internal"
    names = dict(zip(old, (f.name for f in functions), strict=True))
    return Copy(name, code.as_bitcode()), names

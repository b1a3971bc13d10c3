"""The decorators of kernels."""

from collections.abc import Callable
from typing import ParamSpec, TypeVar
from weakref import WeakValueDictionary

from numba import types
from numba.core.sigutils import normalize_signature
from numba.extending import intrinsic

from herringbone.kernels.compiling import constants, elements  # noqa: F401 (register themselves)
from herringbone.kernels.compiling.cache import NamedCache, cached
from herringbone.kernels.compiling.dispatching import CFunction, KernelDispatcher
from herringbone.kernels.compiling.kept_pieces import kept
from herringbone.kernels.compiling.linking import HOT, LINKED, QUICK, RARE, WHOLE

P = ParamSpec("P")
T = TypeVar("T")
_C_OPTIONS = {"nopython": True, "boundscheck": None, "error_model": "numpy"}
_OPTIONS = {**_C_OPTIONS, "fastmath": False, "nogil": True, "forceinline": False}
"""numba takes what is not set from whoever is being compiled: code would go by who calls first."""
UNKNOWN_SIZE = 1 << 40
"""Of an array that others give by its address alone: it cuts no view, and where bounds are checked
no element is out of them."""
_by_content: "WeakValueDictionary[str, KernelDispatcher]" = WeakValueDictionary()
"""Kernels of `inner_kept`, by name: two that are loaded at a time would share one's code."""


def kernel(function: Callable[P, T]) -> Callable[P, T]:
    """Compile a function in the kernel language, and cache it.

    It makes no arrays, so that references to arrays need not be counted: in the compiled loop,
    which passes dozens of them on, that would take most of the time.
    """
    return kept(KernelDispatcher(function, {**_OPTIONS, "_nrt": False}), function)


def inlined(function: Callable[P, T]) -> Callable[P, T]:
    """As `kernel`, for a part of a compiled loop: its callers contain its code.

    A tuple of arrays is passed by copying every field of every array; with dozens of arrays that
    takes longer than most functions.
    """
    return kept(
        KernelDispatcher(function, {**_OPTIONS, "_nrt": False, "forceinline": True}), function
    )


def allocating(function: Callable[P, T]) -> Callable[P, T]:
    """As `kernel`, for a function that makes arrays of its own."""
    return kept(
        KernelDispatcher(function, {**_OPTIONS, "_nrt": True}), function
    )  # whoever calls it


def finding(function: Callable[P, T]) -> Callable[P, T]:
    """As `inlined`, for a function that finds arrays at addresses."""
    return kept(
        KernelDispatcher(function, {**_OPTIONS, "_nrt": True, "forceinline": True}), function
    )


def rare(function: Callable[P, T]) -> Callable[P, T]:
    """As `kernel`, for what seldom happens: its callers call it, and keep their registers."""
    options = {**_OPTIONS, "_nrt": False}
    return kept(KernelDispatcher(function, options, piece_class=RARE), function)


def hot(function: Callable[P, T]) -> Callable[P, T]:
    """As `kernel`, for products whose rows lie side by side in vectors.

    Native FMUs have it for wide vectors, too.
    """
    return kept(KernelDispatcher(function, {**_OPTIONS, "_nrt": False}, piece_class=HOT), function)


def seldom(function: Callable[P, T]) -> Callable[P, T]:
    """As `kernel`, for a function that is called a few times: it is compiled quickly."""
    return kept(KernelDispatcher(function, {**_OPTIONS, "_nrt": False}, QUICK), function)


def inner(owner: str) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """Compile a function that a factory makes for `owner`; its callers hold the cache.

    The owner becomes part of its name, for messages and profiles.
    """

    def decorate(function: Callable[P, T]) -> Callable[P, T]:
        function.__qualname__ = f"{owner}.{function.__qualname__}"
        return KernelDispatcher(function, {**_OPTIONS, "_nrt": False})

    return decorate


def inner_kept(owner: str, content: str) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """As `inner`, for a function that is called from Python, and cached.

    Args:
        owner: see `inner`.
        content: digest of all that the factory was given, and of what that is compiled from. It
            becomes part of the name: code of the same name is the same in all processes, and is
            there once in each.
    """

    def decorate(function: Callable[P, T]) -> Callable[P, T]:
        name = f"{owner}.{content}.{function.__qualname__}"
        found = _by_content.get(name)
        if found is None:
            function.__qualname__ = name
            found = KernelDispatcher(function, {**_OPTIONS, "_nrt": False})
            _by_content[name] = cached(found, function, NamedCache)
        return found

    return decorate


def inner_inlined(owner: str) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """As `inner`, for a function whose callers contain its code, see `inlined`."""

    def decorate(function: Callable[P, T]) -> Callable[P, T]:
        function.__qualname__ = f"{owner}.{function.__qualname__}"
        return KernelDispatcher(function, {**_OPTIONS, "_nrt": False, "forceinline": True})

    return decorate


def outside(owner: str) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """As `inner`, for what seldom happens, see `rare`."""

    def decorate(function: Callable[P, T]) -> Callable[P, T]:
        function.__qualname__ = f"{owner}.{function.__qualname__}"
        return KernelDispatcher(function, {**_OPTIONS, "_nrt": False}, piece_class=RARE)

    return decorate


@intrinsic
def reals_at(typing_context, addresses, index):  # noqa: ANN001, ANN201
    """Pointer to reals whose address stands at `addresses[index]`."""
    signature = types.CPointer(types.float64)(types.CPointer(types.int64), types.int64)

    def generate(context, builder, signature, arguments):  # noqa: ANN001, ANN202
        address = builder.load(builder.gep(arguments[0], [arguments[1]]))
        return builder.inttoptr(address, context.get_value_type(signature.return_type))

    return signature, generate


def c_function(signature: object) -> Callable[[Callable], CFunction]:
    """Compile a function of a module that is called by its C address, and cache it."""

    def decorate(function: Callable) -> CFunction:
        found = CFunction(function, normalize_signature(signature), {}, _C_OPTIONS, WHOLE)
        return cached(found, function)

    return decorate


def c_code(signature: object, function: Callable) -> CFunction:
    """LLVM code of a function that is called by its C address, with all that it calls.

    It is not optimised: that is done for a target, see `fmi.native.objects`.
    """
    compiled = CFunction(function, normalize_signature(signature), {}, _C_OPTIONS, LINKED)
    compiled.compile()
    return compiled

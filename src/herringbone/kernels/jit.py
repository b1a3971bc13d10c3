"""The decorators of kernels, and where compiled kernels are cached."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import ParamSpec, TypeVar

import numba
from numba import types
from numba.core import config
from numba.core.ccallback import CFunc
from numba.extending import intrinsic

from herringbone.core.paths import cache_folder

P = ParamSpec("P")
T = TypeVar("T")
_OPTIONS = {"error_model": "numpy", "fastmath": False, "nogil": True}


@contextmanager
def _kernel_cache() -> Iterator[None]:
    """Cache what is decorated inside in a folder that is named by the content of all sources.

    numba notices a change of the file that holds a cached function, but not of the files that hold
    its callees. Nor does it tell apart how hard it was asked to optimise.
    """
    before = config.CACHE_DIR
    config.CACHE_DIR = str(cache_folder("kernels") / f"optimised-{int(config.OPT)}")
    try:
        yield
    finally:
        config.CACHE_DIR = before


def kernel(function: Callable[P, T]) -> Callable[P, T]:
    """Compile a function in the kernel language, and cache it.

    It makes no arrays, so that references to arrays need not be counted: in the compiled loop,
    which passes dozens of them on, that would take most of the time.
    """
    with _kernel_cache():
        return numba.njit(**_OPTIONS, cache=True, _nrt=False)(function)


def inlined(function: Callable[P, T]) -> Callable[P, T]:
    """As `kernel`, for a part of a compiled loop: its callers contain its code.

    A tuple of arrays is passed by copying every field of every array; with dozens of arrays that
    takes longer than most functions.
    """
    with _kernel_cache():
        return numba.njit(**_OPTIONS, cache=True, _nrt=False, forceinline=True)(function)


def allocating(function: Callable[P, T]) -> Callable[P, T]:
    """As `kernel`, for a function that makes arrays of its own."""
    with _kernel_cache():
        return numba.njit(**_OPTIONS, cache=True, _nrt=True)(function)  # whoever calls it


def inner(owner: str) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """Compile a function that a factory makes for `owner`; its callers hold the cache.

    The owner becomes part of its name: numba tells closures of one factory apart by a counter of
    the process, so that callers that different processes cached could share a symbol.
    """

    def decorate(function: Callable[P, T]) -> Callable[P, T]:
        function.__qualname__ = f"{owner}.{function.__qualname__}"
        return numba.njit(**_OPTIONS, _nrt=False)(function)

    return decorate


@intrinsic
def reals_at(typing_context, addresses, index):  # noqa: ANN001, ANN201
    """Pointer to reals whose address stands at `addresses[index]`."""
    signature = types.CPointer(types.float64)(types.CPointer(types.int64), types.int64)

    def generate(context, builder, signature, arguments):  # noqa: ANN001, ANN202
        address = builder.load(builder.gep(arguments[0], [arguments[1]]))
        return builder.inttoptr(address, context.get_value_type(signature.return_type))

    return signature, generate


def c_function(signature: object) -> Callable[[Callable], CFunc]:
    """Compile a function of a module that is called by its C address, and cache it."""

    def decorate(function: Callable) -> CFunc:
        with _kernel_cache():
            return numba.cfunc(signature, error_model="numpy", cache=True)(function)

    return decorate

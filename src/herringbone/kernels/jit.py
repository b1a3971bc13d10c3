"""The decorators of kernels, and where compiled kernels are cached."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import ParamSpec, TypeVar

import numba
from numba import types
from numba.core import config
from numba.extending import intrinsic

from herringbone.core.paths import cache_folder

P = ParamSpec("P")
T = TypeVar("T")


@contextmanager
def _kernel_cache() -> Iterator[None]:
    """Cache what is decorated inside in a folder that is named by the content of all sources.

    numba notices a change of the file that holds a cached function, but not of the files that hold
    its callees.
    """
    before = config.CACHE_DIR
    config.CACHE_DIR = str(cache_folder("kernels"))
    try:
        yield
    finally:
        config.CACHE_DIR = before


def kernel(function: Callable[P, T]) -> Callable[P, T]:
    """Compile a function in the kernel language, and cache it."""
    with _kernel_cache():
        return numba.njit(error_model="numpy", fastmath=False, nogil=True, cache=True)(function)


def inner(function: Callable[P, T]) -> Callable[P, T]:
    """Compile a function that is made by a factory; its callers hold the cache."""
    return numba.njit(error_model="numpy", fastmath=False, nogil=True)(function)


@intrinsic
def reals_at(typing_context, addresses, index):  # noqa: ANN001, ANN201
    """Pointer to reals whose address stands at `addresses[index]`."""
    signature = types.CPointer(types.float64)(types.CPointer(types.int64), types.int64)

    def generate(context, builder, signature, arguments):  # noqa: ANN001, ANN202
        address = builder.load(builder.gep(arguments[0], [arguments[1]]))
        return builder.inttoptr(address, context.get_value_type(signature.return_type))

    return signature, generate


def c_function(signature: object, function: Callable[P, T]) -> Callable[P, T]:
    """Compile a function that is called by its C address."""
    return numba.cfunc(signature, error_model="numpy")(function)

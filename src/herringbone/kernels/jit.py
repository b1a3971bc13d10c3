"""The decorators of kernels, and where compiled kernels are cached."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import ParamSpec, TypeVar

import numba
from numba.core import config

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


def c_function(signature: object, function: Callable[P, T]) -> Callable[P, T]:
    """Compile a function that is called by its C address."""
    return numba.cfunc(signature, error_model="numpy")(function)

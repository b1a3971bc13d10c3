"""The decorator of every kernel, and where compiled kernels are cached."""

from collections.abc import Callable
from typing import ParamSpec, TypeVar

import numba
from numba.core import config

from herringbone.core.paths import cache_folder

P = ParamSpec("P")
T = TypeVar("T")


def kernel(function: Callable[P, T]) -> Callable[P, T]:
    """Compile a function in the kernel language, and cache it.

    numba notices a change of the file that holds a cached function, but not of the files that hold
    its callees. The cache therefore lies in a folder named by the content of all sources.
    """
    before = config.CACHE_DIR
    config.CACHE_DIR = str(cache_folder("kernels"))
    try:
        return numba.njit(error_model="numpy", fastmath=False, nogil=True, cache=True)(function)
    finally:
        config.CACHE_DIR = before


def inner(function: Callable[P, T]) -> Callable[P, T]:
    """Compile a function that takes other kernels as arguments; its callers hold the cache."""
    return numba.njit(error_model="numpy", fastmath=False, nogil=True)(function)

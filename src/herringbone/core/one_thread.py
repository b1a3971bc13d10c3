"""Linear algebra on one thread: our matrices are small, and idle threads spin on other cores."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache

from threadpoolctl import ThreadpoolController

_BLAS = "blas"


@cache
def _libraries() -> ThreadpoolController:
    """The BLAS libraries of this process; looking for them takes milliseconds."""
    import scipy.linalg  # noqa: F401, PLC0415 (brings its own, which would be missed)

    return ThreadpoolController()


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Context in which linear algebra takes one thread; of no effect where there is no BLAS."""
    with _libraries().limit(limits=1, user_api=_BLAS):
        yield

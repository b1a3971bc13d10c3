"""Linear algebra on one thread: our matrices are small, and idle threads spin on other cores."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from threading import Lock
from typing import Any

from threadpoolctl import ThreadpoolController


class _Open:
    """Contexts that are open in this process: the number of threads is of all of it."""

    def __init__(self) -> None:
        self.lock, self.count = Lock(), 0
        self.limit: Any = None


_open = _Open()


@cache
def _libraries() -> ThreadpoolController:
    """The BLAS libraries of this process; looking for them takes milliseconds."""
    import scipy.linalg  # noqa: F401, PLC0415 (brings its own, which would be missed)

    return ThreadpoolController()


def _take_control() -> None:
    """Let the number be set from this thread, whichever has set it before.

    Since 3.8 threadpoolctl lets one thread alone set it, and passes over what others ask for; here
    the contexts take turns, so that the last one may always bring it back.
    """
    for library in _libraries().lib_controllers:
        clear = getattr(library, "clear_controlling_thread", None)
        if clear is not None:
            clear(force=True)


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Context in which linear algebra takes one thread; of no effect where there is no BLAS.

    When the last context of all threads ends, the number is what it was before the first one.
    """
    with _open.lock:
        if _open.count == 0:
            _take_control()
            _open.limit = _libraries().limit(limits=1, user_api="blas")
        _open.count += 1
    try:
        yield
    finally:
        with _open.lock:
            _open.count -= 1
            if _open.count == 0:
                _take_control()
                _open.limit.restore_original_limits()

"""An FMU that ends the process must not make it look like a success.

`exit(0)` inside a call of an FMU ends this process with code 0 and without a word. While the guard
is up, an exit handler of the C library says so, and ends the process with another code. A call of
`_exit` runs no handlers; where the C library has no `__cxa_atexit` (Windows), there is no guard.
"""

import contextlib
import ctypes
import os
from collections.abc import Iterator
from typing import Any

from herringbone.core import EXIT_CODES, OutcomeKind

_HANDLER = ctypes.CFUNCTYPE(None, ctypes.c_void_p)
_LINE = (
    b"herringbone: part_failed: an FMU ended the process by a call of exit(); what was not written "
    b"yet is lost\n"
)
_up: set[int] = set()
"""Addresses of the marks of guards that are up, in any thread."""


@_HANDLER
def _at_exit(mark: int | None) -> None:
    if mark in _up:  # else its guard is taken back, whatever others are up
        os.write(2, _LINE)
        os._exit(EXIT_CODES[OutcomeKind.PART_FAILED])


@contextlib.contextmanager
def exit_guard() -> Iterator[None]:
    """Context in which FMUs are called; may be nested, and up in several threads at a time."""
    library: Any = None if os.name == "nt" else ctypes.CDLL(None)
    if not hasattr(library, "__cxa_atexit"):
        yield
        return
    mark = ctypes.c_int()  # its address stands for the module to which the handler belongs
    at = ctypes.addressof(mark)
    library.__cxa_atexit(_at_exit, ctypes.byref(mark), ctypes.byref(mark))
    _up.add(at)
    try:
        yield
    finally:
        _up.remove(at)
        library.__cxa_finalize(ctypes.byref(mark))  # runs the handler, and takes it back

"""Rounding and flushing to zero, which an FMU that Python calls may change for the whole thread.

Calls from compiled code see to that themselves, see `cosim.loops.float_modes`.
"""

import ctypes
import functools
import os
from collections.abc import Callable
from typing import ParamSpec, TypeVar

_Given = ParamSpec("_Given")
_Found = TypeVar("_Found")
_MOST_BYTES = 64


class _Modes:
    """The floating-point environment of this process, as it was when this was imported."""

    def __init__(self) -> None:
        self._kept = ctypes.create_string_buffer(_MOST_BYTES)
        self.are_kept = os.name == "posix"
        if self.are_kept:
            self._library = ctypes.CDLL(None)
            self._library.fegetenv(self._kept)

    def restore(self) -> None:
        if self.are_kept:
            self._library.fesetenv(self._kept)


_modes = _Modes()


def leave_modes() -> None:
    """FMUs may change the modes of this process: it is theirs."""
    _modes.are_kept = False


def keeping_modes(function: Callable[_Given, _Found]) -> Callable[_Given, _Found]:
    """The function, after which modes are as they were."""

    @functools.wraps(function)
    def call(*arguments: _Given.args, **options: _Given.kwargs) -> _Found:
        try:
            return function(*arguments, **options)
        finally:
            _modes.restore()

    return call

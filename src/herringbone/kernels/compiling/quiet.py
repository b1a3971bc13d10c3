"""What numba prepares in case that somebody debugs it, or that it has to warn, left out.

It describes each statement to loggers that nobody hears, and changes the filters of Python's
warnings around each, to collect what it may say of it: together a twentieth of the time that a
kernel takes before LLVM. Here warnings go to Python's filters as they are.

What it leans on inside of numba is tested for every minor version that is admitted.
"""

import logging
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext

from numba.core import byteflow, ssa
from numba.core.errors import WarningsFixer

_TALKING = (byteflow, ssa)
"""Modules that describe each statement."""
_loggers = {module: module._logger for module in _TALKING}
_catch = WarningsFixer.catch_warnings
_as_they_are: AbstractContextManager[None] = nullcontext()


class _Unheard:
    """A logger that nobody listens to."""

    def debug(self, message: str, *arguments: object) -> None:
        """Nothing."""


_UNHEARD = _Unheard()


def _caught(
    fixer: WarningsFixer, filename: str | None = None, lineno: int | None = None
) -> AbstractContextManager[None]:
    del fixer, filename, lineno
    return _as_they_are


@contextmanager
def quiet() -> Iterator[None]:
    """While kernels are compiled; who debugs numba hears it as ever."""
    if WarningsFixer.catch_warnings is _caught:
        yield
        return
    WarningsFixer.catch_warnings = _caught
    for module, logger in _loggers.items():
        if not logger.isEnabledFor(logging.DEBUG):
            module._logger = _UNHEARD
    try:
        yield
    finally:
        WarningsFixer.catch_warnings = _catch
        for module, logger in _loggers.items():
            module._logger = logger

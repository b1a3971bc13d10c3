"""What numba prepares in case that somebody debugs it, or that it has to warn, left out.

It describes each statement to loggers that nobody hears, changes the filters of Python's warnings
around each, to collect what it may say of it, and, where colorama is installed, sets up a
terminal's colours for each template that refuses a call: together a tenth of the time that a kernel
takes before LLVM. Here warnings go to Python's filters as they are, and messages have no colours.

What it leans on inside of numba is tested for every minor version that is admitted.
"""

import logging
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext

from numba.core import byteflow, ssa
from numba.core.errors import WarningsFixer, termcolor

_TALKING = (byteflow, ssa)
"""Modules that describe each statement."""
_loggers = {module: module._logger for module in _TALKING}
_catch = WarningsFixer.catch_warnings
_as_they_are: AbstractContextManager[None] = nullcontext()
_Colours = type(termcolor())
_COLOURED = "_markup"
"""Method of numba's colours that sets up the terminal; none without colorama."""


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


def _plain(colours: object, message: str, *style: str | None) -> str:
    del colours, style
    return message


@contextmanager
def quiet() -> Iterator[None]:
    """While kernels are compiled; who debugs numba hears it as ever."""
    if WarningsFixer.catch_warnings is _caught:
        yield
        return
    WarningsFixer.catch_warnings = _caught
    coloured = getattr(_Colours, _COLOURED, None)
    if coloured is not None:
        setattr(_Colours, _COLOURED, _plain)
    for module, logger in _loggers.items():
        if not logger.isEnabledFor(logging.DEBUG):
            module._logger = _UNHEARD
    try:
        yield
    finally:
        WarningsFixer.catch_warnings = _catch
        if coloured is not None:
            setattr(_Colours, _COLOURED, coloured)
        for module, logger in _loggers.items():
            module._logger = logger

"""What belongs to the whole process of a cell, and an FMU may change."""

import ctypes
import locale
import os
import platform
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np

_X86 = {"x86_64", "AMD64"}
_WORDS, _MXCSR = 16, 7
"""Words of 32 bits that an fenv_t has at the most; the one that is the register MXCSR."""
_OLD_MODES, _MODES = 0x0F3F, 0xFFC0
"""Of the control word of x87, which stands first, and of MXCSR: all but flags."""


def surroundings() -> dict[str, object]:
    """What belongs to the whole process, by what it is called."""
    umask = os.umask(0)
    os.umask(umask)
    return {
        "the working folder": _or_none(Path.cwd),
        "the umask": umask,
        "the locale": locale.setlocale(locale.LC_ALL),
        "open descriptors": tuple(_is_open(k) for k in range(3)),
        "the number of threads": _or_none(lambda: len(list(Path("/proc/self/task").iterdir()))),
        "the floating-point environment": _modes(),
    }


def _or_none(find: Callable[[], object]) -> object:
    try:
        return find()
    except OSError:
        return None


def _is_open(descriptor: int) -> bool:
    return _or_none(lambda: os.fstat(descriptor) and True) is True


def _modes() -> tuple[int, ...]:
    """Rounding, precision, masks of exceptions, and what becomes of denormal numbers."""
    library, words = ctypes.CDLL(None), (ctypes.c_uint32 * _WORDS)()
    if platform.machine() in _X86 and hasattr(library, "fegetenv"):
        library.fegetenv(words)
        return words[0] & _OLD_MODES, words[_MXCSR] & _MODES
    rounding = int(library.fegetround()) if hasattr(library, "fegetround") else 0
    return rounding, float(np.float64(sys.float_info.min) / 2.0) == 0.0

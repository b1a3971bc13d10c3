"""What belongs to the whole process of a cell, and an FMU may change."""

import ctypes
import locale
import os
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np


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


def _modes() -> tuple[int, bool]:
    """Rounding mode, by what the C library calls it, and whether denormal numbers become zero."""
    library = ctypes.CDLL(None)
    rounding = int(library.fegetround()) if hasattr(library, "fegetround") else 0
    return rounding, float(np.float64(sys.float_info.min) / 2.0) == 0.0

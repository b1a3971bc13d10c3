"""Memory that was freed stays with the process, and need not be asked for again.

Arrays of some megabytes that come and go cost more in page faults than in arithmetic where the
allocator hands each one back at once: a worker of Dask, whose environment asks for that
(MALLOC_TRIM_THRESHOLD_=65536), took twice the CPU time for a run.
"""

import ctypes
import sys
from functools import cache

_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3
"""Parameters of mallopt of glibc."""
_KEPT, _OWN_PAGES = 32 * 2**20, 16 * 2**20
"""Bytes at the end of the heap that are kept; of a block that gets pages of its own."""


@cache
def keep_freed_memory() -> None:
    """Once in a process, for good; of no effect where the C library is not glibc."""
    if sys.platform != "linux":
        return
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is not None:
        mallopt(_TRIM_THRESHOLD, _KEPT)
        mallopt(_MMAP_THRESHOLD, _OWN_PAGES)

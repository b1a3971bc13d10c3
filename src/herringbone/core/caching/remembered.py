"""What was found in this process, by content: nothing is parsed or linearised twice."""

from collections import OrderedDict
from collections.abc import Callable, Hashable
from pathlib import Path
from stat import S_ISREG
from threading import Lock
from time import time_ns
from typing import Generic, TypeVar

from herringbone.core.caching.built import content_of
from herringbone.core.places.noted import note

T = TypeVar("T")
_SETTLED = 2_000_000_000
"""Age of a change [ns] from which another one would show in the time that the file system keeps."""
_MOST_FILES = 4096


class Remembered(Generic[T]):
    """The last things that were found, by what they depend on.

    Args:
        most: that are kept; those that were not asked for longest go first.
    """

    def __init__(self, most: int) -> None:
        self._most, self._lock = most, Lock()
        self._known: OrderedDict[Hashable, T] = OrderedDict()

    def __call__(self, key: Hashable, find: Callable[[], T]) -> T:
        """What is known under a key, or is found now; what `find` raises is raised, and not kept.

        Who changes what it gets, changes it for all.
        """
        with self._lock:
            if key in self._known:
                self._known.move_to_end(key)
                return self._known[key]
        found = find()
        with self._lock:
            self._known[key] = found
            while len(self._known) > self._most:
                self._known.popitem(last=False)
        return found


_contents: Remembered[str] = Remembered(_MOST_FILES)


def content_key(file: Path) -> str:
    """SHA-256 of a file's content in hexadecimal digits; "" if it is no file, or cannot be read.

    A file that has the size and time that it had is not read again, unless it was changed so lately
    that another change might not show.
    """
    note(file)
    try:
        status = file.stat()
    except OSError:
        return ""
    if not S_ISREG(status.st_mode):
        return ""
    if time_ns() - max(status.st_mtime_ns, status.st_ctime_ns) < _SETTLED:
        return content_of(file)
    stamp = str(file), status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns
    return _contents(stamp, lambda: content_of(file))

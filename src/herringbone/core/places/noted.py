"""Which files are asked for: what an answer depends on besides what was asked.

Whoever asks whether a file of people is there, what is in it, or what content it has, does so
through `core.places.files`, `core.reading` or `core.caching`, which note it here.
"""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager

_seeing: list[Callable[[str], None]] = []


def note(file: object) -> None:
    """Note that a file or folder is asked for, there or not; an entry of an archive is none."""
    if _seeing and isinstance(file, str | os.PathLike):
        path = os.path.abspath(file)  # noqa: PTH100 (links stay as they are)
        for see in _seeing:
            see(path)


@contextmanager
def noting(see: Callable[[str], None]) -> Iterator[None]:
    """Context in which a function is called with the absolute path of each file asked for.

    It is called before the file is read, from any thread.
    """
    _seeing.append(see)
    try:
        yield
    finally:
        _seeing.remove(see)

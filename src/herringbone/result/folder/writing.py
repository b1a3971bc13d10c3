"""Writing so that a file is whole or not there, and a full disk is one line."""

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path
from typing import IO

from herringbone.core import HerringboneError
from herringbone.core.places import files

_ROOM = frozenset({"No space left on device", "Disk quota exceeded", "File too large"})


def refused(error: OSError, file: Path) -> HerringboneError:
    """What is said where a file cannot be written."""
    why = error.strerror or str(error)
    what = "make room there, or choose another folder" if why in _ROOM else "choose another folder"
    return HerringboneError(f"cannot write {file}: {why}; {what}")


def write_all(descriptor: int, content: bytes | memoryview) -> None:
    """Write all bytes to a file; raises OSError."""
    left = memoryview(content).cast("B")
    while left:
        left = left[os.write(descriptor, left) :]


@contextlib.contextmanager
def replacing(file: Path, *, text: bool = True) -> Iterator[IO]:
    """A file to be written in the place of another one, which it takes in the end, whole.

    Args:
        file: to be written.
        text: UTF-8, lines as they are; else bytes.

    Raises:
        HerringboneError: it cannot be written; what was there stays.
    """
    try:
        with files.replacing(file, text=text) as stream:
            yield stream
    except OSError as error:
        raise refused(error, file) from error


def write_text(file: Path, content: str) -> None:
    """Write a text file whole; raises HerringboneError."""
    with replacing(file) as stream:
        stream.write(content)

"""Writing so that a file is whole or not there, and a full disk is one line."""

import contextlib
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import IO

from herringbone.core import HerringboneError
from herringbone.result.folder.names import PART

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
    part = None
    try:
        descriptor, name = tempfile.mkstemp(PART, f".{file.name}.", file.parent)
        part = Path(name)
        plain = {"encoding": "utf-8", "newline": ""} if text else {}
        with os.fdopen(descriptor, "w" if text else "wb", **plain) as stream:  # type: ignore[call-overload]
            yield stream
            stream.flush()
            os.fsync(stream.fileno())
        part.chmod(0o666 & ~_umask())
        part.replace(file)
        part = None
    except OSError as error:
        raise refused(error, file) from error
    finally:
        if part is not None:
            with contextlib.suppress(OSError):
                part.unlink()


def write_text(file: Path, content: str) -> None:
    """Write a text file whole; raises HerringboneError."""
    with replacing(file) as stream:
        stream.write(content)


def _umask() -> int:
    """What a new file's permissions leave out."""
    mask = os.umask(0)
    os.umask(mask)
    return mask

"""Files in the cache: written whole, and known again by a digest that stands beside or in them."""

import contextlib
import hashlib
import json
import logging
import os
import tempfile
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from herringbone.core.errors import reason
from herringbone.core.places.files import PART
from herringbone.core.places.paths import CACHE_VARIABLE, is_trusted, make_private

_LOG = logging.getLogger("herringbone")
_SUFFIX = ".sha256"
_LIST = "all_files.json"
"""Names of the files of a folder that belong together, written last."""
_STALE = 3600.0
"""Seconds after which a file that was not written to its end is of a dead process."""


def _stamp(file: Path) -> Path:
    return file.with_name(file.name + _SUFFIX)


def write_file(file: Path, content: bytes) -> None:
    """Write a file so that others see all of it or nothing; raises OSError, which names it."""
    make_private(file.parent)
    _sweep(file.parent)
    with tempfile.NamedTemporaryFile(dir=file.parent, suffix=PART, delete=False) as part:
        try:
            part.write(content)
            part.close()
            os.replace(part.name, file)  # noqa: PTH105 (atomic on all platforms)
        except OSError as error:
            Path(part.name).unlink(missing_ok=True)
            why = f"{reason(error)}; make room there, or set {CACHE_VARIABLE} to another folder"
            raise OSError(error.errno, why, str(file)) from error


def _sweep(folder: Path) -> None:
    """Remove what dead processes did not write to its end."""
    for part in folder.glob(f"*{PART}"):
        with contextlib.suppress(OSError):
            if time.time() - part.stat().st_mtime > _STALE:
                part.unlink()


def store(file: Path, content: bytes) -> None:
    """Put a file into the cache."""
    write_file(file, content)
    write_file(_stamp(file), _digest(content).encode())


def read_stored(file: Path) -> bytes | None:
    """Content of a file in the cache, as it was stored; else None.

    A line is logged if it is damaged, or of another user.
    """
    try:
        content = file.read_bytes()
        stamp = _stamp(file).read_bytes()
    except OSError:
        return None
    return content if is_sound(file, content, stamp.decode(errors="replace")) else None


def is_sound(file: Path, content: bytes, digest: str) -> bool:
    """True if a file is of this user, and its content has its digest; a line is logged if not.

    Raises:
        OSError: it is gone.
    """
    if not is_trusted(file):
        _LOG.warning("%s is of another user, or others can write it; it is made anew", file)
        return False
    if _digest(content) == digest:
        return True
    _LOG.warning("%s is damaged; it is made anew", file)
    return False


def is_stored(file: Path) -> bool:
    """True if the cache has the file as it was stored; see `read_stored`."""
    return read_stored(file) is not None


@contextlib.contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Context that one process, or thread, at a time enters for a folder, which is made if needed.

    What one makes there, the others find made. A process that dies lets the next one in; where
    there are no locks, all enter.
    """
    descriptor = -1
    with contextlib.suppress(OSError, ImportError):
        import fcntl  # noqa: PLC0415 (not on Windows)

        make_private(folder)
        descriptor = os.open(folder, os.O_RDONLY | os.O_CLOEXEC)
        fcntl.flock(descriptor, fcntl.LOCK_EX)
    try:
        yield
    finally:
        if descriptor >= 0:
            os.close(descriptor)


def store_all(folder: Path, contents: Mapping[str, bytes]) -> None:
    """Put files into a folder of the cache that belong together, by name."""
    for name, content in contents.items():
        store(folder / name, content)
    store(folder / _LIST, json.dumps(sorted(contents)).encode())


def all_stored(folder: Path) -> list[Path]:
    """Files of a folder that were put there together; none if any is missing or damaged."""
    listed = read_stored(folder / _LIST)
    files = [folder / name for name in json.loads(listed)] if listed else []
    return files if all([is_stored(file) for file in files]) else []


def keep(file: Path, found: object) -> None:
    """Keep what can be found again, as JSON behind its digest; not being able to does no harm."""
    text = json.dumps(found).encode()
    with contextlib.suppress(OSError):
        write_file(file, f"{_digest(text)}\n".encode() + text)


def kept(file: Path) -> Any:  # noqa: ANN401 (what was kept)
    """What was kept in a file; None if there is nothing, or it is damaged or of another user.

    A line is logged if it is damaged, or of another user.
    """
    try:
        digest, _, text = file.read_bytes().partition(b"\n")
        sound = is_sound(file, text, digest.decode(errors="replace"))
    except OSError:
        return None
    return json.loads(text) if sound else None


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()

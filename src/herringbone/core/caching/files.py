"""Files in the cache: written whole, and known again by a digest that stands beside them."""

import hashlib
import logging
import os
import tempfile
from pathlib import Path

_LOG = logging.getLogger("herringbone")
_SUFFIX = ".sha256"


def _stamp(file: Path) -> Path:
    return file.with_name(file.name + _SUFFIX)


def write_file(file: Path, content: bytes) -> None:
    """Write a file so that others see all of it or nothing."""
    file.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile(dir=file.parent, suffix=".part", delete=False) as part:
        part.write(content)
    os.replace(part.name, file)  # noqa: PTH105 (atomic on all platforms)


def store(file: Path, content: bytes) -> None:
    """Put a file into the cache."""
    write_file(file, content)
    write_file(_stamp(file), hashlib.sha256(content).hexdigest().encode())


def is_stored(file: Path) -> bool:
    """True if the cache has the file as it was stored; a line is logged if it is damaged."""
    try:
        content = file.read_bytes()
        stamp = _stamp(file).read_bytes()
    except OSError:
        return False
    if hashlib.sha256(content).hexdigest().encode() == stamp:
        return True
    _LOG.warning("%s is damaged; it is made anew", file)
    return False

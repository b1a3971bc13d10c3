"""Which FMUs this installation built itself, known again by their content."""

import contextlib
import hashlib
from pathlib import Path

from herringbone.core.caching.files import write_file
from herringbone.core.places.paths import cache_root, is_trusted

_FOLDER = "built-fmus"


def note_built(content: bytes) -> None:
    """Remember an FMU that was built here."""
    with contextlib.suppress(OSError):  # it is a stranger then, which costs little
        write_file(cache_root() / _FOLDER / hashlib.sha256(content).hexdigest(), b"")


def content_of(file: Path) -> str:
    """SHA-256 of a file's content in hexadecimal digits; "" if it cannot be read."""
    try:
        with file.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError:
        return ""


def is_built(file: Path) -> bool:
    """True if the content of a file was built here, whatever its name."""
    content = content_of(file)
    mark = cache_root() / _FOLDER / content
    return bool(content) and mark.is_file() and is_trusted(mark) and is_trusted(mark.parent)

"""Which FMUs this installation built itself, known again by their content."""

import contextlib
import hashlib
from pathlib import Path

from herringbone.core.caching.files import write_file
from herringbone.core.paths import cache_root

_FOLDER = "built-fmus"


def _mark(content: bytes) -> Path:
    return cache_root() / _FOLDER / hashlib.sha256(content).hexdigest()


def note_built(content: bytes) -> None:
    """Remember an FMU that was built here."""
    with contextlib.suppress(OSError):  # it is a stranger then, which costs little
        write_file(_mark(content), b"")


def is_built(file: Path) -> bool:
    """True if the content of a file was built here, whatever its name."""
    try:
        return _mark(file.read_bytes()).is_file()
    except OSError:
        return False

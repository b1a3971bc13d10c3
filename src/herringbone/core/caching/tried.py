"""What trials of foreign FMUs told, in one folder of the cache, so that it can be forgotten."""

import shutil
from pathlib import Path

from herringbone.core.caching.answers import FOLDER as ANSWERS
from herringbone.core.places.paths import cache_root

_FOLDER = "tried"


def tried_folder(kind: str) -> Path:
    """Folder of one kind of what is found by trials; it need not be there."""
    return cache_root() / _FOLDER / kind


def forget_tried() -> None:
    """Forget all of it, of all FMUs, and the answers of commands, which may depend on it."""
    for folder in (_FOLDER, ANSWERS):
        shutil.rmtree(cache_root() / folder, ignore_errors=True)

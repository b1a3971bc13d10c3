"""Arrays and texts by name, kept in one file; its folder has a largest size.

A file is the digest of all that follows, a line of JSON with names and shapes, or texts, and then
the numbers as they stand in memory, so that every bit is kept.
"""

import contextlib
import hashlib
import json
import math
import os
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from herringbone.core.caching.files import is_sound, write_file

Kept = np.ndarray | str
"""An array of float64, or a text."""
MOST_BYTES = 256_000_000
"""Of all files in a folder; those that were not used longest go first."""
_DIGEST = hashlib.sha256().digest_size
_NUMBER = np.dtype("<f8")


def keep_arrays(file: Path, found: Mapping[str, Kept], most: int = MOST_BYTES) -> None:
    """Keep arrays and texts; not being able to does no harm.

    Args:
        file: its folder holds nothing else but such files.
        found: what is kept, by name.
        most: bytes of all files in the folder; more than that are not kept at all.
    """
    head = [[name, x if isinstance(x, str) else list(x.shape)] for name, x in found.items()]
    numbers = [x.astype(_NUMBER).tobytes() for x in found.values() if not isinstance(x, str)]
    content = b"".join([json.dumps(head).encode(), b"\n", *numbers])
    if _DIGEST + len(content) > most:
        return
    with contextlib.suppress(OSError):
        write_file(file, hashlib.sha256(content).digest() + content)
        _prune(file.parent, most)


def kept_arrays(file: Path) -> dict[str, Kept]:
    """What was kept in a file; nothing if there is none.

    A line is logged if it is damaged, or of another user.
    """
    try:
        whole = file.read_bytes()
        content = whole[_DIGEST:]
        if not is_sound(file, content, whole[:_DIGEST].hex()):
            return {}
    except OSError:
        return {}
    with contextlib.suppress(OSError):
        os.utime(file)
    first = content.index(b"\n") + 1
    found: dict[str, Kept] = {}
    for name, given in json.loads(content[:first]):
        if isinstance(given, str):
            found[name] = given
            continue
        count = math.prod(given)
        numbers = np.frombuffer(content, _NUMBER, count, first)
        found[name] = numbers.astype(float).reshape(given)
        first += count * _NUMBER.itemsize
    return found


def _prune(folder: Path, most: int) -> None:
    """Remove files that were not used longest, while all together are larger than they may be."""
    known = sorted((s.st_mtime_ns, s.st_size, f) for f in folder.iterdir() if (s := f.stat()))
    left = sum(size for _, size, _ in known)
    for _, size, file in known:
        if left <= most:
            return
        file.unlink(missing_ok=True)
        left -= size

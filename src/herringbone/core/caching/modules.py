"""The modules of the package as syntax; files that have not changed are not parsed again."""

import os
import sys
from collections.abc import Iterator, Mapping
from hashlib import sha256
from pathlib import Path

from herringbone.core.caching.files import keep, kept
from herringbone.core.caching.syntax import Syntax, syntax_of
from herringbone.core.places.paths import PACKAGE, cache_root

Stamp = tuple[str, int, int]
"""Path of a file, time of its last change [ns], size."""
_NAME = PACKAGE.name
_CODE = ".py"


def stamps_of(folder: Path, suffix: str = "") -> list[Stamp]:
    """Of all files in a folder and in those in it, by path; those with a suffix, if one is given.

    Folders whose names have a point or end with underscores hold nothing of ours.
    """
    found: list[Stamp] = []
    todo = [str(folder)]
    while todo:
        with os.scandir(todo.pop()) as entries:
            for entry in entries:
                if "." in entry.name:
                    if entry.name.endswith(suffix) and entry.is_file():
                        status = entry.stat()
                        found.append((entry.path, status.st_mtime_ns, status.st_size))
                elif not entry.name.endswith("__") and entry.is_dir():
                    todo.append(entry.path)
    return sorted(found)


class Modules(Mapping[str, Syntax]):
    """All modules of the package by name.

    All are read now; what nobody asks for is not parsed.

    Attributes:
        stamps: of their files, by name.
    """

    def __init__(self) -> None:
        self._memo = cache_root() / f"syntax-{sys.version_info[0]}.{sys.version_info[1]}.json"
        known = kept(self._memo) or {}
        self.stamps: dict[str, Stamp] = {}
        self._found: dict[str, Syntax] = {}
        self._sources: dict[str, bytes] = {}
        outside = len(str(PACKAGE.parent)) + 1
        for stamp in stamps_of(PACKAGE, _CODE):
            place = stamp[0][outside : -len(_CODE)]
            name = place.replace(os.sep, ".").removesuffix(".__init__")
            if name == _NAME:  # it only says where names are
                continue
            self.stamps[name] = stamp
            old = known.get(name)
            if old and tuple(old[:3]) == stamp:
                self._found[name] = Syntax(old[3], tuple(old[4]))
            else:
                self._sources[name] = Path(stamp[0]).read_bytes()
        self._kept = set(self._found) if self._found.keys() == known.keys() else set()

    def __getitem__(self, name: str) -> Syntax:
        if name not in self._found:
            self._found[name] = _syntax_of(self._sources.pop(name))
        return self._found[name]

    def __contains__(self, name: object) -> bool:
        return name in self.stamps

    def __iter__(self) -> Iterator[str]:
        return iter(self.stamps)

    def __len__(self) -> int:
        return len(self.stamps)

    def keep(self) -> None:
        """Keep what is known now for other processes."""
        if self._kept != self._found.keys():
            self._kept = set(self._found)
            found = sorted(self._found.items())
            keep(self._memo, {m: [*self.stamps[m], s.digest, list(s.imports)] for m, s in found})


def _syntax_of(source: bytes) -> Syntax:
    try:
        return syntax_of(source.decode())
    except SyntaxError:  # whoever imports it gets the message
        return Syntax(sha256(source).hexdigest(), ())

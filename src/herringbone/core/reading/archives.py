"""Archives of strangers: FMUs, SSPs and packed housings are zip files."""

import stat
import struct
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from typing import Final

from herringbone.core.errors import HerringboneError, ResourceError, reason
from herringbone.core.names import shown
from herringbone.core.places.files import is_file, is_folder
from herringbone.core.reading.texts import DAMAGE, MEBIBYTE

_MOST_ENTRIES: Final = 65_535
_LONGEST_PATH: Final = 512
_ALWAYS, _RATIO, _LARGEST = 256 * MEBIBYTE, 100, 8192 * MEBIBYTE
"""Unpacked bytes that are always taken; as multiple of the file's; and at most."""
_KNOWN = {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}
_DAMAGE = (*DAMAGE, struct.error)


class Archive:
    """An open zip file whose entries have been checked.

    Args:
        file: for messages.
        content: the open file.
        error: what is raised.
    """

    def __init__(self, file: Path, content: zipfile.ZipFile, error: type[HerringboneError]) -> None:
        self._file, self._content, self._error = file, content, error
        self.names = frozenset(content.namelist())
        self.root = zipfile.Path(content)

    def read(self, name: str, most: int) -> bytes:
        """Content of an entry of at most `most` bytes; raises the archive's kind of error."""
        if name not in self.names:
            raise self._error(f"{self._file}: it contains no {name}")
        if self._content.getinfo(name).file_size > most:
            raise self._error(f"{self._file}: {name} is larger than {most // MEBIBYTE} MiB")
        try:
            return self._content.read(name)
        except _DAMAGE as damage:
            raise self._error(f"{self._file}: {name} cannot be read: {_why(damage)}") from damage

    def extract(self, folder: Path) -> None:
        """Write all entries into a folder; raises the archive's kind of error."""
        try:
            self._content.extractall(folder)
        except _DAMAGE as damage:
            raise self._error(f"{self._file} cannot be unpacked: {_why(damage)}") from damage


@contextmanager
def open_archive(
    file: Path, kind: str, error: type[HerringboneError] = ResourceError
) -> Iterator[Archive]:
    """Open a zip file.

    Args:
        file: the file.
        kind: what it should be, such as "an FMU".
        error: what is raised.

    Raises:
        HerringboneError: of the kind `error`: there is no file, it is no zip file, or an entry is a
            link, encrypted, packed in an unusual way, too large, or would be written elsewhere.
    """
    if not is_file(file):
        raise error(f"{file} is a folder" if is_folder(file) else f"there is no file {file}")
    try:
        content = zipfile.ZipFile(file)
    except _DAMAGE as damage:
        raise error(f"{file} is not {kind}: {_why(damage)}") from damage
    with content:
        if problem := _problem(content.infolist(), file.stat().st_size):
            raise error(f"{file}: {problem}; refused")
        yield Archive(file, content, error)


def _why(damage: Exception) -> str:
    return reason(damage) or type(damage).__name__


def _problem(entries: list[zipfile.ZipInfo], packed: int) -> str | None:
    """What makes the entries dangerous, if anything."""
    if len(entries) > _MOST_ENTRIES:
        return f"{len(entries)} entries; at most {_MOST_ENTRIES} are read"
    if not all(entry.filename for entry in entries):
        return "an entry has no name"
    unpacked = sum(entry.file_size for entry in entries)
    if unpacked > min(_LARGEST, max(_ALWAYS, _RATIO * packed)):
        return f"its {packed} bytes would become {unpacked / MEBIBYTE:.0f} MiB"
    found: dict[str, tuple[int, int]] = {}
    for entry in entries:
        content = entry.file_size, entry.CRC
        if not entry.is_dir() and found.setdefault(entry.filename, content) != content:
            return f"entry {shown(entry.filename)} stands twice, with other content"
    return next((text for entry in entries if (text := _problem_of(entry))), None)


def _problem_of(entry: zipfile.ZipInfo) -> str | None:
    name = entry.filename
    path = PurePosixPath(name.replace("\\", "/"))
    if len(name) > _LONGEST_PATH:
        return f"entry {shown(name)} has a name of {len(name)} characters"
    if path.is_absolute() or ".." in path.parts or any(":" in part for part in path.parts):
        return f"entry '{name}' would be written outside its folder"
    if stat.S_ISLNK(entry.external_attr >> 16):
        return f"entry {shown(name)} is a link"
    if entry.flag_bits & 0x1:
        return f"entry {shown(name)} is encrypted"
    if entry.compress_type not in _KNOWN:
        return f"entry {shown(name)} is packed by method {entry.compress_type}, not deflated"
    return None

"""A kind of files, and how one of them is put where it is read."""

import io
import tempfile
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from herringbone.core import HerringboneError
from herringbone.core.places import temporary
from herringbone.core.places.temporary import remove_temporary_folder


@dataclass(frozen=True)
class Kind:
    """A kind of file.

    Attributes:
        name: also of the test.
        content: of a good file.
        read: reads what is in a folder, into which the damaged content is put first.
        weight: how often it is tried, against others.
    """

    name: str
    content: bytes
    read: Callable[[bytes, Path], object]
    weight: int = 4


def file_of(name: str, read: Callable[[Path], object]) -> Callable[[bytes, Path], object]:
    def put(content: bytes, folder: Path) -> object:
        (folder / name).write_bytes(content)
        return read(folder / name)

    return put


def zipped(entries: dict[str, bytes], method: int = zipfile.ZIP_STORED) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", method) as archive:
        for name, content in entries.items():
            archive.writestr(name, content)
    return packed.getvalue()


@contextmanager
def temporary_folders() -> Iterator[None]:
    """Remove what would otherwise stay until the process ends."""
    before = set(temporary._locks)
    try:
        yield
    finally:
        for folder in set(temporary._locks) - before:
            remove_temporary_folder(folder)


def written(write: Callable[[Path], object]) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        write(Path(folder) / "x")
        return (Path(folder) / "x").read_bytes()


def refused(kind: Kind, content: bytes, folder: Path) -> bool:
    """Read a content; True if it was refused, in one line."""
    try:
        kind.read(content, folder)
    except HerringboneError as error:
        assert "\n" not in str(error)
        assert str(error).isprintable()
        return True
    return False

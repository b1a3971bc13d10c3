"""Files whose names come from people and files: questions about them, and writing them whole."""

import contextlib
import os
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import IO

from herringbone.core.names import shown
from herringbone.core.places.noted import note

PART = ".part"
"""Ends the name of a file that is not written to its end."""


@contextlib.contextmanager
def replacing(file: Path, *, text: bool = True) -> Iterator[IO]:
    """A file to be written in the place of another one, which it takes in the end, whole.

    What is no file, such as a pipe, is written as it is.

    Args:
        file: to be written.
        text: UTF-8, lines as they are; else bytes.

    Raises:
        OSError: it cannot be written; what was there stays.
    """
    mode = "w" if text else "wb"
    plain = {"encoding": "utf-8", "newline": ""} if text else {}
    if file.exists() and not file.is_file():
        with file.open(mode, **plain) as stream:  # type: ignore[call-overload]
            yield stream
        return
    target = Path(os.path.realpath(file))
    descriptor, name = tempfile.mkstemp(PART, f".{target.name}.", target.parent)
    part = Path(name)
    try:
        with os.fdopen(descriptor, mode, **plain) as stream:  # type: ignore[call-overload]
            yield stream
            stream.flush()
            os.fsync(stream.fileno())
        part.chmod(0o666 & ~_umask())
        part.replace(target)
    except BaseException:
        with contextlib.suppress(OSError):
            part.unlink()
        raise


def write_whole(file: Path, content: str | bytes) -> None:
    """Write a file so that it is there whole, or as it was before; raises OSError."""
    with replacing(file, text=isinstance(content, str)) as stream:
        stream.write(content)


def _umask() -> int:
    """What a new file's permissions leave out."""
    mask = os.umask(0)
    os.umask(mask)
    return mask


def is_file(path: Path) -> bool:
    """True for a file; False also for what no file can be called, such as too long a name."""
    note(path)
    return os.path.isfile(path)  # noqa: PTH113 (pathlib's raises for such names)


def is_folder(path: Path) -> bool:
    """True for a folder; False also for what no folder can be called."""
    note(path)
    return os.path.isdir(path)  # noqa: PTH112 (pathlib's raises for such names)


def not_utf8(path: Path) -> str:
    """The first name on the way to a path that no text can hold, in quotes; "" if there is none.

    On Linux a name is any bytes, and those that are not UTF-8 cannot be written into a file.
    """
    for name in path.absolute().parts:
        try:
            name.encode()
        except UnicodeEncodeError:
            return shown(name)
    return ""


def beside(value: float | str, folder: Path) -> float | str:
    """A value from a file in a folder, or from a command that runs there.

    A text that is the relative name of a file there becomes its absolute path. Any other text stays
    as it is: a name in the resources of a component.
    """
    if not isinstance(value, str) or not value or Path(value).is_absolute():
        return value
    file = folder / value
    return str(file.absolute()) if is_file(file) else value


def as_texts(values: Mapping[str, float | str | Path] | None) -> dict[str, float | str]:
    """Values by name, with paths as text; empty for None."""
    return {k: str(v) if isinstance(v, Path) else v for k, v in (values or {}).items()}


def same_folder() -> contextlib.AbstractContextManager[None]:
    """Context after which the working folder is what it was, whatever FMUs did to it."""
    return contextlib.chdir(Path.cwd())

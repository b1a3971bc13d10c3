"""Texts of strangers: of limited size, in UTF-8, with or without byte order mark."""

import stat
import zipfile
import zlib
from pathlib import Path
from typing import Final

from herringbone.core.caching.remembered import content_key
from herringbone.core.errors import HerringboneError, ResourceError, reason
from herringbone.core.places.files import is_file
from herringbone.core.places.noted import note

AnyPath = Path | zipfile.Path
"""A file, or an entry of an open archive."""

MEBIBYTE: Final = 1 << 20
LARGEST_TEXT: Final = 16 * MEBIBYTE
"""Bytes of a table; `fmi/native/c` has the same limit."""
LARGEST_MODEL: Final = 2048 * MEBIBYTE
"""Bytes of what a finite element program wrote."""

DAMAGE: Final = (
    zipfile.BadZipFile, zlib.error, EOFError, OSError, ValueError, RuntimeError, KeyError,
    ArithmeticError, IndexError, MemoryError, zipfile.LargeZipFile,
)  # fmt: skip
"""What reading a damaged archive may raise."""


def read_bytes(
    file: AnyPath, most: int = LARGEST_TEXT, error: type[HerringboneError] = ResourceError
) -> bytes:
    """Content of a file of at most `most` bytes.

    Args:
        file: a file, or an entry of an open archive.
        most: bytes.
        error: what is raised.

    Raises:
        HerringboneError: of the kind `error`: it is missing, no file, damaged or too large.
    """
    check_regular(file, error)
    try:
        with file.open("rb") as stream:
            content = stream.read(most + 1)
    except DAMAGE as damage:
        raise error(f"cannot read {file}: {_why(damage)}") from damage
    if len(content) > most:
        raise error(f"cannot read {file}: it is larger than {most // MEBIBYTE} MiB")
    return content


def check_regular(file: AnyPath, error: type[HerringboneError] = ResourceError) -> None:
    """Refuse what is no file, such as a pipe, on which reading might wait for ever."""
    note(file)
    try:
        regular = not isinstance(file, Path) or stat.S_ISREG(file.stat().st_mode)
    except DAMAGE as damage:
        raise error(f"cannot read {file}: {_why(damage)}") from damage
    if not regular:
        raise error(f"cannot read {file}: it is no file")


def _why(damage: Exception) -> str:
    """Why it cannot be read; a missing entry of an archive has no words of its own."""
    if isinstance(damage, KeyError | FileNotFoundError) and not getattr(damage, "strerror", ""):
        return "it is not in the archive"
    return reason(damage) or type(damage).__name__


def read_text(
    file: AnyPath,
    error: type[HerringboneError] = ResourceError,
    *,
    most: int = LARGEST_TEXT,
    ascii_only: bool = False,
) -> str:
    """Text of a file, without byte order mark; each line ends with a line feed.

    Args:
        file, error, most: see `read_bytes`.
        ascii_only: what is no ASCII becomes a mark (of formats that have it in comments only).

    Raises:
        HerringboneError: of the kind `error`: see `read_bytes`, or it is no text in UTF-8.
    """
    content = read_bytes(file, most, error)
    try:
        text = content.decode("ascii", "replace") if ascii_only else content.decode("utf-8-sig")
    except UnicodeDecodeError as damage:
        raise error(f"cannot read {file}: it is no UTF-8 text (byte {damage.start + 1})") from None
    if "\0" in text:
        raise error(f"cannot read {file}: it is no UTF-8 text (it has a zero byte)")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def text_key(file: AnyPath) -> str:
    """What tells a text's content from others; "" if it is not known, or is refused."""
    if not isinstance(file, Path) or not is_file(file) or file.stat().st_size > LARGEST_TEXT:
        return ""
    return content_key(file)


def lines_of(text: str) -> list[str]:
    """Lines of a text; only line feeds end one, as in the native readers."""
    lines = text.split("\n")
    return lines if lines[-1] else lines[:-1]

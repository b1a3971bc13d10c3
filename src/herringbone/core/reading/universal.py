"""Universal files of test systems: their data sets, read by pyuff (extra `import`).

What begins and ends a data set is found here, and pyuff reads each from a file of its own: it drops
a last one that does not end, takes a mark from the end of longer lines, and misses one before
blanks; a set would be lost, or taken for another, without a word.

Source: Universal File Formats for Modal Analysis Testing, University of Cincinnati, SDRL.
"""

import contextlib
import io
import re
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from herringbone.core.errors import HerringboneError, ResourceError
from herringbone.core.places.temporary import temporary_folder
from herringbone.core.reading.numbers import whole
from herringbone.core.reading.texts import LARGEST_MODEL, read_bytes

_MARK = re.compile(rb"    -1(?<![^\r\n]    -1)[ \t]*(?=[\r\n]|\Z)")  # literal first: fast
"""A line that begins or ends a data set; blanks may follow."""
_KIND = re.compile(rb"(?:\r\n|[\r\n]) *(\d{1,6})([bB]?)")
"""Second line of a data set: its number, and b if it is binary."""
_BINARY = re.compile(rb"^    58[bB].{12}(.{12})(.{12}).*\n", re.MULTILINE)
"""Second line of a data set 58b."""


class _Block(NamedTuple):
    """A data set: its place in the file, from 1, its number, and its bytes without marks."""

    place: int
    kind: int
    body: bytes


def universal_sets(path: Path, kinds: Collection[int]) -> list[dict[str, Any]]:
    """Data sets of some kinds, in the order of the file.

    Args:
        path: the file.
        kinds: numbers of data sets, such as 58; others are passed over.

    Raises:
        HerringboneError: pyuff is missing.
        ResourceError: not readable, no universal file, truncated or malformed.
    """
    try:
        import pyuff  # noqa: PLC0415 (optional)
    except ImportError as error:
        raise HerringboneError(
            "universal files need pyuff: pip install 'herringbone[import]'"
        ) from error
    content = read_bytes(path, LARGEST_MODEL)
    try:
        blocks = list(_blocks(content, kinds))
    except ResourceError as error:
        raise ResourceError(f"{path}: {error}") from None
    found = []
    with temporary_folder() as scratch:
        for block in blocks:
            alone = scratch / "set.unv"
            alone.write_bytes(b"    -1" + block.body + b"    -1\n")
            try:
                with contextlib.redirect_stdout(io.StringIO()):  # it prints what it does not know
                    found.append(pyuff.UFF(str(alone)).read_sets(0))
            except Exception as error:  # pyuff raises bare Exception for every defect
                raise ResourceError(
                    f"{path}: data set {block.place} ({block.kind}) is malformed"
                ) from error
    return found


def _blocks(content: bytes, kinds: Collection[int]) -> Iterator[_Block]:
    """Data sets of some kinds.

    Raises:
        ResourceError: without the file's name: no universal file, truncated or malformed.
    """
    marks = [mark.span() for mark in _MARK.finditer(_without_signals(content))]
    if not marks:
        raise ResourceError("it is no universal file: it has no mark '    -1'")
    if len(marks) % 2:
        raise ResourceError("it is truncated: the last data set does not end with '    -1'")
    pairs = zip(marks[::2], marks[1::2], strict=True)
    for place, ((_, begin), (end, _)) in enumerate(pairs, 1):
        body = content[begin:end]
        head = _KIND.match(body)
        if head is None:
            raise ResourceError(
                f"data set {place} does not begin with its number; are there "
                "as many lines '    -1' at ends as at beginnings?"
            )
        if (kind := int(head[1])) in kinds:
            yield _Block(place, kind, body if head[2] else _unmistakable(body))


def _unmistakable(text: bytes) -> bytes:
    """A data set without what pyuff mistakes: blanks for values, a last field -1 for a mark."""
    lines = (line.rstrip() for line in text.splitlines())
    return b"".join(line + (b" \n" if line.endswith(b"    -1") else b"\n") for line in lines)


def _without_signals(content: bytes) -> bytes:
    """A file with line ends for its binary signals (58b), in which bytes may be those of a mark.

    The second line of such a set tells the lines of text after it, and the bytes after these.

    Raises:
        ResourceError: without the file's name: it does not.
    """
    parts, at = [], 0
    while head := _BINARY.search(content, at):
        begin = head.end()
        try:
            lines, size = (whole(field.decode("ascii").strip()) for field in head.groups())
            for _ in range(lines):
                begin = content.index(b"\n", begin) + 1
            end = min(begin + max(size, 0), len(content))
        except ValueError as error:
            raise ResourceError("the head of a data set 58b is malformed or cut off") from error
        parts += [content[at:begin], b"\n" * (end - begin)]
        at = end
    return b"".join([*parts, content[at:]])

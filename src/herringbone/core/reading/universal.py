"""Universal files of test systems: their data sets, read by pyuff (extra `import`).

pyuff drops a last data set that does not end; this is checked here.

Source: Universal File Formats for Modal Analysis Testing, University of Cincinnati, SDRL.
"""

import contextlib
import io
import re
from collections.abc import Collection
from pathlib import Path
from typing import Any

from herringbone.core.errors import HerringboneError, ResourceError
from herringbone.core.reading.texts import LARGEST_MODEL, read_bytes

_MARK = b"    -1"
_BINARY = re.compile(rb"^    58[bB].{12}(.{12})(.{12}).*\n", re.MULTILINE)
"""Second line of a data set 58b."""


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
        marks = sum(line.rstrip() == _MARK for line in _texts(content).splitlines())
    except ValueError as error:
        raise ResourceError(
            f"{path}: the head of a data set 58b is malformed or cut off"
        ) from error
    if marks == 0:
        raise ResourceError(f"{path} is no universal file: it has no mark '    -1'")
    if marks % 2:
        raise ResourceError(f"{path} is truncated: the last data set does not end with '    -1'")
    n, kind = 0, "none"
    found = []
    try:
        with contextlib.redirect_stdout(io.StringIO()):  # it prints what it does not know
            file = pyuff.UFF(str(path))
            for n, kind in enumerate(file.get_set_types(), 1):
                if kind in kinds:
                    found.append(file.read_sets(n - 1))
    except Exception as error:  # pyuff raises bare Exception for every defect
        raise ResourceError(f"{path}: data set {n} ({kind}) is malformed") from error
    return found


def _texts(content: bytes) -> bytes:
    """A file without its binary signals (58b), in which a byte may be a line's end or a mark's.

    The second line of such a set tells the lines of text after it, and the bytes after these;
    ValueError if it does not.
    """
    texts, at = [], 0
    while head := _BINARY.search(content, at):
        lines, size = (int(field) for field in head.groups())
        begin = head.end()
        for _ in range(lines):
            begin = content.index(b"\n", begin) + 1
        texts.append(content[at:begin])
        at = begin + size
    return b"".join([*texts, content[at:]])

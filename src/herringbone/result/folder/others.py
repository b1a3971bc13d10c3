"""Values of other types than real, a JSON array per row, appended while a run goes on."""

import json
import os
from collections.abc import Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from herringbone.core import ResourceError
from herringbone.core.errors import reason
from herringbone.result.folder.writing import refused, write_all


class OtherFile:
    """Rows of a run, beside those of `RowFile`.

    Args:
        file: made anew, or opened if `rows` is given.
        rows: of an existing file: how many stay.

    Raises:
        HerringboneError: the file cannot be written.
    """

    def __init__(self, file: Path, rows: int | None = None) -> None:
        self.file = file
        how = os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | (os.O_TRUNC if rows is None else 0)
        try:
            self._descriptor = os.open(file, how, 0o666)
        except OSError as error:
            raise refused(error, file) from error
        self.cut(rows or 0)

    def append(self, rows: Sequence[Sequence[Any]]) -> None:
        """Append rows; raises HerringboneError, and the file is as before."""
        text = "".join(f"{json.dumps(list(row), ensure_ascii=False)}\n" for row in rows)
        size = os.lseek(self._descriptor, 0, os.SEEK_END)
        try:
            write_all(self._descriptor, text.encode("utf-8", "surrogateescape"))
        except OSError as error:
            os.ftruncate(self._descriptor, size)
            raise refused(error, self.file) from error

    def cut(self, rows: int) -> None:
        """Keep the first rows only; raises HerringboneError."""
        try:
            with self.file.open("rb") as stream:
                size = sum(len(line) for line in islice(stream, rows))
            os.ftruncate(self._descriptor, size)
        except OSError as error:
            raise refused(error, self.file) from error

    def close(self) -> None:
        """Close the file."""
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1


def counted_others(file: Path) -> int:
    """Rows that were written to their end; raises ResourceError."""
    try:
        with file.open("rb") as stream:
            return sum(line.endswith(b"\n") for line in stream)
    except OSError as error:
        raise ResourceError(f"cannot read {file}: {error.strerror}") from error


def read_others(
    file: Path, types: Mapping[str, str], first: int, last: int
) -> dict[str, np.ndarray]:
    """Columns (last - first,) by name, of their types, of rows first ... last - 1.

    Raises:
        ResourceError: the file cannot be read, or has other columns.
    """
    try:
        with file.open("rb") as stream:
            rows = [json.loads(line) for line in islice(stream, first, last)]
        columns = list(zip(*rows, strict=True)) if rows else [()] * len(types)
        pairs = zip(types.items(), columns, strict=True)
        return {name: np.array(column, dtype=kind) for (name, kind), column in pairs}
    except (OSError, ValueError, TypeError) as error:
        raise ResourceError(f"cannot read {file}: {reason(error)}") from error

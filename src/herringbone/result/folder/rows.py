"""Rows of doubles in a file that NumPy reads, appended while a run goes on.

The header has a fixed length, so that its number of rows can be written anew; it is written after
the rows, in one call. A process that dies in between leaves rows that nobody counts.
"""

import os
from pathlib import Path

import numpy as np

from herringbone.core import HerringboneError, ResourceError
from herringbone.result.folder.writing import refused, write_all

_MAGIC = b"\x93NUMPY\x01\x00"
_HEADER = 128
"""Bytes before the first row."""
_DOUBLE = 8


def _header(rows: int, columns: int) -> bytes:
    text = f"{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {columns}), }}"
    length = _HEADER - len(_MAGIC) - 2
    return _MAGIC + length.to_bytes(2, "little") + text.ljust(length - 1).encode() + b"\n"


class RowFile:
    """Rows of a run, time first.

    Args:
        file: made anew, or opened if `rows` is given.
        columns: numbers in a row.
        rows: of an existing file: how many stay.

    Attributes:
        rows: that the file has.

    Raises:
        HerringboneError: the file cannot be written.
    """

    def __init__(self, file: Path, columns: int, rows: int | None = None) -> None:
        self.file, self.columns, self.rows = file, columns, rows or 0
        how = os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | (os.O_TRUNC if rows is None else 0)
        try:
            self._descriptor = os.open(file, how, 0o666)
            self._cut()
        except OSError as error:
            raise refused(error, file) from error

    @property
    def _row(self) -> int:
        return _DOUBLE * self.columns

    def append(self, rows: np.ndarray) -> None:
        """Append rows (n, columns).

        Raises:
            HerringboneError: they cannot be written; those for which there was room stay.
        """
        block = np.ascontiguousarray(rows, dtype="<f8")
        try:
            os.lseek(self._descriptor, _HEADER + self.rows * self._row, os.SEEK_SET)
            write_all(self._descriptor, block.data)
            self._count(self.rows + len(block))
        except OSError as error:
            self._keep_whole(len(block))
            raise refused(error, self.file) from error
        self.rows += len(block)

    def cut(self, rows: int) -> None:
        """Keep the first rows only; raises HerringboneError."""
        self.rows = min(rows, self.rows)
        try:
            self._cut()
        except OSError as error:
            raise refused(error, self.file) from error

    def _cut(self) -> None:
        self._count(self.rows)
        os.ftruncate(self._descriptor, _HEADER + self.rows * self._row)

    def _count(self, rows: int) -> None:
        os.lseek(self._descriptor, 0, os.SEEK_SET)
        write_all(self._descriptor, _header(rows, self.columns))

    def _keep_whole(self, most: int) -> None:
        """After an error: rows that are whole, `most` at most, are counted; no others."""
        try:
            there = (os.fstat(self._descriptor).st_size - _HEADER) // self._row
            if there > self.rows:
                self._count(min(there, self.rows + most))
                self.rows = min(there, self.rows + most)
            os.ftruncate(self._descriptor, _HEADER + self.rows * self._row)
        except OSError:
            return

    def sync(self) -> None:
        """Bring the rows to the disk; raises HerringboneError."""
        try:
            os.fsync(self._descriptor)
        except OSError as error:
            raise refused(error, self.file) from error

    def read(self, first: int, last: int) -> np.ndarray:
        """Rows first ... last - 1, as far as there are any; raises HerringboneError."""
        return read_rows(self.file, self.columns, first, min(last, self.rows))

    def close(self) -> None:
        """Close the file."""
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1


def counted_rows(file: Path, columns: int) -> int:
    """Rows that a file has: those of its header, as far as they are there.

    Raises:
        ResourceError: it is no file of so many columns.
    """
    try:
        with file.open("rb") as stream:
            header = stream.read(_HEADER)
        size = file.stat().st_size
    except OSError as error:
        raise ResourceError(f"cannot read {file}: {error.strerror}") from error
    rows = header.partition(b"'shape': (")[2].partition(b",")[0]
    if not rows.isdigit() or header != _header(int(rows), columns):
        raise ResourceError(f"{file}: it is no table of {columns} columns of this package")
    return min(int(rows), (size - _HEADER) // (_DOUBLE * columns))


def read_rows(file: Path, columns: int, first: int, last: int) -> np.ndarray:
    """Rows first ... last - 1 of a file, as an array of their own.

    Raises:
        HerringboneError: they cannot be read.
    """
    count = max(last - first, 0) * columns
    try:
        found = np.fromfile(file, "<f8", count, offset=_HEADER + _DOUBLE * columns * first)
    except OSError as error:
        raise HerringboneError(f"cannot read {file}: {error.strerror}") from error
    return found.reshape(-1, columns)


def mapped_rows(file: Path, columns: int, rows: int) -> np.ndarray:
    """Rows (rows, columns), read when they are used; changes stay in memory."""
    if not rows:
        return np.empty((0, columns))
    return np.memmap(file, "<f8", "c", _HEADER, (rows, columns))

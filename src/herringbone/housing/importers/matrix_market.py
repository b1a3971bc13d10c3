"""Importer of matrices in Matrix Market files: stiffness, mass, and perhaps the seat input.

The entries are read by numpy: scipy 1.17's `mmread` ends the process on some truncated files.

Source: R. F. Boisvert, R. Pozo, K. A. Remington, The Matrix Market Exchange Formats, NISTIR 5935.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

import numpy as np
import scipy.sparse as sp

from herringbone.core import ResourceError, reason
from herringbone.core.reading.numbers import whole
from herringbone.core.reading.texts import check_regular
from herringbone.housing.importers.matrix_model import MatrixModel, check_size

_BANNER = "%%matrixmarket"
_SYMMETRIES = {"general": 0.0, "symmetric": 1.0, "skew-symmetric": -1.0}
"""What an entry is multiplied by on the other side of the diagonal."""
_VALUE = np.dtype([("value", np.float64)])
_ENTRY = np.dtype([("row", np.int64), ("column", np.int64), ("value", np.float64)])
_LONGEST_LINE = 1024
_LEAST_BYTES = 2
"""That an entry takes."""


def read_matrix_market(paths: Sequence[str | Path]) -> MatrixModel:
    """Read stiffness, mass and, as a third file, the seat input (N, 12).

    Raises:
        ResourceError: not two or three files, not readable, complex, or sizes that differ.
    """
    files = [Path(path) for path in paths]
    if len(files) not in {2, 3}:
        raise ResourceError(
            f"{len(files)} Matrix Market file(s); give stiffness, mass and perhaps the seat input"
        )
    stiffness, mass, *rest = map(read_matrix, files)
    if stiffness.shape != mass.shape or stiffness.shape[0] != stiffness.shape[1]:
        raise ResourceError(
            f"{files[0]} is {stiffness.shape}, {files[1]} is {mass.shape}; both must be square and "
            "of the same size"
        )
    if rest and rest[0].shape != (mass.shape[0], 12):
        raise ResourceError(
            f"{files[2]} is {rest[0].shape}; the seat input must be ({mass.shape[0]}, 12)"
        )
    seat_input = rest[0].toarray() if rest else None
    names = ", ".join(file.name for file in files)
    return MatrixModel(stiffness, mass, None, {}, seat_input, {"tool": "matrices", "file": names})


@dataclass(frozen=True)
class _Head:
    """What stands before the entries.

    Attributes:
        coordinate: entries are row, column, value; else values alone, column by column.
        mirror: see `_SYMMETRIES`.
        rows, columns: size of the matrix.
        entries: how many follow.
    """

    coordinate: bool
    mirror: float
    rows: int
    columns: int
    entries: int


def read_matrix(file: Path) -> sp.csr_array:
    """One real matrix; raises ResourceError."""
    check_regular(file)
    try:
        with file.open(encoding="ascii", newline="") as stream:
            head = _head(stream)
            _check_room(head, file.stat().st_size)
            return _entries(stream, head)
    except ResourceError as error:
        raise ResourceError(f"{file}: {error}") from None
    except (OSError, MemoryError) as error:
        raise ResourceError(f"cannot read {file}: {reason(error)}") from error
    except (ValueError, OverflowError) as error:
        raise ResourceError(f"{file} is no valid Matrix Market file: {error}") from error


def _head(stream: TextIO) -> _Head:
    """Banner, comments and sizes; raises ValueError."""
    banner = stream.readline(_LONGEST_LINE).lower().split()
    if len(banner) != 5 or banner[:2] != [_BANNER, "matrix"]:
        raise ValueError("its first line must be %%MatrixMarket matrix FORMAT FIELD SYMMETRY")
    _, _, form, field, symmetry = banner
    if field == "complex" or symmetry == "hermitian":
        raise ValueError("it is complex; real matrices are needed")
    known = (form, {"coordinate", "array"}), (field, {"real", "double", "integer"})
    for word, words in (*known, (symmetry, set(_SYMMETRIES))):
        if word not in words:
            raise ValueError(f"{word!r}: it must be {' or '.join(sorted(words))}")
    line = "%"
    while line.startswith("%") or (line and not line.strip()):
        line = stream.readline(_LONGEST_LINE)
    sizes = [whole(word) for word in line.split()]
    coordinate = form == "coordinate"
    if len(sizes) != (3 if coordinate else 2) or min(sizes) < 1:
        raise ValueError(f"{line[:40]!r} does not tell its size")
    rows, columns = sizes[:2]
    check_size(rows, columns)
    if symmetry != "general" and rows != columns:
        raise ValueError(f"it is {symmetry}, but has {rows} rows and {columns} columns")
    mirror = _SYMMETRIES[symmetry]
    stored = {0.0: rows * columns, 1.0: rows * (rows + 1) // 2, -1.0: rows * (rows - 1) // 2}
    return _Head(coordinate, mirror, rows, columns, sizes[2] if coordinate else stored[mirror])


def _check_room(head: _Head, size: int) -> None:
    """Refuse a head that tells of more entries than a file of so many bytes can have."""
    if head.entries * _LEAST_BYTES > size:
        raise ValueError(f"it is too short for {head.entries} entries")


def _entries(stream: TextIO, head: _Head) -> sp.csr_array:
    """The matrix; raises ValueError if the entries are not those that the head tells of."""
    table = np.loadtxt(stream, _ENTRY if head.coordinate else _VALUE, comments="%", ndmin=1)
    if len(table) != head.entries:
        raise ValueError(f"{len(table)} entries; its head tells of {head.entries}")
    values = table["value"]
    if not np.isfinite(values).all():
        raise ValueError(f"entry {int(np.argmin(np.isfinite(values))) + 1} is no finite number")
    rows, columns = _places(table, head)
    if head.mirror:
        other = rows != columns
        values = np.concatenate([values, head.mirror * values[other]])
        rows, columns = (
            np.concatenate([rows, columns[other]]),
            np.concatenate([columns, rows[other]]),
        )
    return sp.csr_array((values, (rows, columns)), shape=(head.rows, head.columns))


def _places(table: np.ndarray, head: _Head) -> tuple[np.ndarray, np.ndarray]:
    """Row and column of each entry, from 0."""
    if not head.coordinate:
        shape = (head.columns, head.rows)
        if head.mirror == 0.0:
            columns, rows = np.indices(shape).reshape(2, -1)
        else:
            columns, rows = np.triu_indices(head.rows, 0 if head.mirror > 0.0 else 1)
        return rows, columns
    rows, columns = table["row"] - 1, table["column"] - 1
    for place, size, what in ((rows, head.rows, "row"), (columns, head.columns, "column")):
        outside = (place < 0) | (place >= size)
        if outside.any():
            entry = int(np.argmax(outside))
            raise ValueError(f"entry {entry + 1} has {what} {place[entry] + 1} of {size}")
    return rows, columns

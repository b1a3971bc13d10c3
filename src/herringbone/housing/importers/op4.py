"""Importer of Nastran OUTPUT4 files in ASCII, dense, sparse or big.

Binary files are told apart and refused: there is no reader of them that could be trusted here.

Source: MSC Nastran DMAP Programmer's Guide, OUTPUT4 module, format of the file.
"""

import re
from collections.abc import Iterator
from pathlib import Path

import scipy.sparse as sp

from herringbone.core import ResourceError
from herringbone.core.reading.numbers import number, whole
from herringbone.core.reading.texts import LARGEST_MODEL, read_bytes
from herringbone.housing.importers.matrix_model import MatrixModel, check_size, only_name

_HEADER = re.compile(r"^(.{8})(.{8})(.{8})(.{8})(.{8})\s*\d*P?,?(\d+)[ED](\d+)\.(\d+)")
_REAL = {1, 2}
_STRING = 65536
"""A string of a sparse column begins with row + 65536 (words + 1)."""


def read_op4(path: str | Path) -> MatrixModel:
    """Read a stiffness matrix (name begins with K) and a mass matrix (name begins with M).

    Raises:
        ResourceError: not readable, binary, truncated, malformed, complex, a name twice, or not
            exactly one matrix of each kind.
    """
    path = Path(path)
    data = read_bytes(path, LARGEST_MODEL)
    if b"\x00" in data[:4096] or not data[:4096].isascii():
        raise ResourceError(
            f"{path} is a binary OUTPUT4 file; write it formatted: "
            "ASSIGN OUTPUT4='file.op4',UNIT=11,FORM=FORMATTED"
        )
    try:
        matrices = _by_name(data.decode("ascii").splitlines())
    except ResourceError as error:
        raise ResourceError(f"{path}: {error}") from None
    except (ValueError, IndexError) as error:
        raise ResourceError(f"{path} is malformed: {error}") from error
    names = list(matrices)
    stiffness, mass = (_full(matrices[only_name(names, letter, path)]) for letter in "KM")
    if stiffness.shape != mass.shape:
        raise ResourceError(f"{path}: stiffness is {stiffness.shape}, mass is {mass.shape}")
    return MatrixModel(
        stiffness, mass, None, {}, None, {"tool": "Nastran OUTPUT4", "file": path.name}
    )


def _by_name(lines: list[str]) -> dict[str, sp.csr_array]:
    found: dict[str, sp.csr_array] = {}
    for name, matrix in _matrices(lines):
        if name in found:
            raise ResourceError(f"matrix {name} stands twice; keep one")
        found[name] = matrix
    return found


def _matrices(lines: list[str]) -> Iterator[tuple[str, sp.csr_array]]:
    at = 0
    while at < len(lines):
        if not lines[at].strip():
            at += 1
            continue
        header = _HEADER.match(lines[at])
        if header is None:
            raise ResourceError(f"line {at + 1} is no OUTPUT4 header: '{lines[at].strip()[:40]}'")
        columns, rows, _, kind = (int(header[k]) for k in range(1, 5))
        name = header[5].strip().upper()
        if kind not in _REAL:
            raise ResourceError(f"matrix {name} has type {kind}; real ones, 1 and 2, are read")
        check_size(abs(rows), columns)
        at, matrix = _columns(lines, at + 1, abs(rows), columns, int(header[7]), name)
        yield name, matrix


def _columns(
    lines: list[str], at: int, rows: int, columns: int, width: int, name: str
) -> tuple[int, sp.csr_array]:
    """Line after the matrix, and the matrix.

    Lines of integers announce a column (3 integers) or a string of a sparse one (1 or 2); the
    values follow on lines of reals, which all have a decimal point.
    """
    found = sp.dok_array((rows, columns))
    column, row = 0, 0
    for n in range(at, len(lines)):
        line = lines[n]
        if "." in line:
            if column == columns:  # the closing column has one dummy value
                return n + 1, found.tocsr()
            for k in range(0, len(line.rstrip()), width):
                if not (0 <= row < rows and 0 <= column < columns):
                    raise ResourceError(f"line {n + 1}: a value outside of matrix {name}")
                found[row, column] = number(line[k : k + width].replace("D", "E"))
                row += 1
            continue
        integers = [whole(text) for text in line.split()]
        if len(integers) == 3:
            column, row = integers[0] - 1, integers[1] - 1
        elif len(integers) == 2:
            row = integers[1] - 1
        else:
            row = integers[0] % _STRING - 1
    raise ResourceError(f"the file is truncated in matrix {name}")


def _full(matrix: sp.csr_array) -> sp.csr_array:
    """A symmetric matrix of which only one triangle may be stored."""
    lower, upper = sp.tril(matrix, -1), sp.triu(matrix, 1)
    if (lower.nnz == 0) != (upper.nnz == 0):
        matrix = matrix + lower.T + upper.T
    return sp.csr_array(matrix)

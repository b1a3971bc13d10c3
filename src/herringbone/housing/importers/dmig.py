"""Importer of Nastran DMIG cards (bulk data or punch file), with GRID cards for coordinates.

Small, large and free field formats are read; real matrices only. pyNastran would read more, but it
asks for numpy below 2.

Source: MSC Nastran Quick Reference Guide, bulk data entries DMIG, GRDSET and GRID, and format of
entries.
"""

import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from herringbone.core import ResourceError
from herringbone.core.reading.numbers import number, whole
from herringbone.core.reading.texts import LARGEST_MODEL, lines_of, read_text
from herringbone.housing.importers.matrix_model import MatrixModel, Row, only_name

_SYMMETRIC = 6
_REAL = {1, 2}
_SAME = 1e-6
"""Relative difference of an element and its transpose that is rounding."""
_SHORT, _LONG = 8, 16
_CARDS = {"DMIG", "GRDSET", "GRID"}
_CP, _CD = 2, 6
"""Fields of GRID and GRDSET: coordinate systems of the position and of the displacements."""
_BARE_EXPONENT = re.compile(r"(?<=[\d.])([+-]\d+)$")


class _Matrix(NamedTuple):
    """Form, type, and elements by row and column."""

    form: int
    kind: int
    elements: dict[tuple[Row, Row], float]


def read_dmig(path: str | Path) -> MatrixModel:
    """Read a stiffness matrix (name begins with K) and a mass matrix (name begins with M).

    Raises:
        ResourceError: not readable, malformed, complex, not symmetric, an element given twice,
            local coordinates, or not exactly one matrix of each kind.
    """
    path = Path(path)
    text = read_text(path, most=LARGEST_MODEL, ascii_only=True)
    matrices: dict[str, _Matrix] = {}
    grids: list[list[str]] = []
    default: list[str] = []
    try:
        for card in _cards(text):
            if card[0] == "DMIG":
                _read_dmig(card[1:], matrices)
            elif card[0] == "GRID":
                grids.append(card)
            else:
                default = card
        coordinates = _coordinates(grids, default)
    except ResourceError as error:
        raise ResourceError(f"{path}: {error}") from None
    except (ValueError, IndexError) as error:
        raise ResourceError(f"{path}: a DMIG, GRDSET or GRID card is malformed: {error}") from error
    stiffness, mass = (_symmetric(matrices, letter, path) for letter in "KM")
    rows = sorted({row for matrix in (stiffness, mass) for pair in matrix for row in pair})
    return MatrixModel(
        _assemble(stiffness, rows), _assemble(mass, rows), tuple(rows), coordinates, None,
        {"tool": "Nastran DMIG", "file": path.name},
    )  # fmt: skip


def _cards(text: str) -> Iterator[list[str]]:
    """Fields of each DMIG, GRDSET and GRID entry, continuations joined."""
    card: list[str] = []
    for raw in lines_of(text):
        line = raw.split("$")[0].rstrip()
        if not line:
            continue
        fields = _fields(line)
        if fields[0] in {"", "+", "*"} or fields[0][0] in "+*":
            card += fields[1:]
            continue
        if card and card[0] in _CARDS:
            yield card
        card = [fields[0].rstrip("*").upper(), *fields[1:]]
    if card and card[0] in _CARDS:
        yield card


def _fields(line: str) -> list[str]:
    """Name and the data fields of a line: 8 in small or free format, 4 in large format."""
    if "," in line:
        fields = [field.strip() for field in line.split(",")]
        count = 5 if "*" in fields[0] else 9
        return (fields + [""] * count)[:count]
    line = line.expandtabs(8).ljust(80)
    name = line[:_SHORT].strip()
    width, count = (_LONG, 4) if "*" in name else (_SHORT, 8)
    return [name, *(line[_SHORT + width * k :][:width].strip() for k in range(count))]


def _integer(field: str) -> int:
    return whole(field) if field else 0


def _real(field: str) -> float:
    """A Nastran real: 1.5, 1.5E+3, 1.5D+3, 1.5+3; an empty field is 0."""
    if not field:
        return 0.0
    text = field.upper().replace("D", "E")
    return number(text if "E" in text else _BARE_EXPONENT.sub(r"E\1", text))


def _coordinates(grids: list[list[str]], default: list[str]) -> dict[int, np.ndarray]:
    """Positions of nodes by label; a field that GRID leaves blank is that of GRDSET.

    Raises:
        ResourceError: a coordinate system is not the basic one, or a node has two places.
    """
    found: dict[int, np.ndarray] = {}
    for grid in grids:
        label, position = whole(grid[1]), np.array([_real(x) for x in grid[3:6]])
        for at in (_CP, _CD):
            given = grid[at] or "".join(default[at : at + 1])
            if _integer(given):
                whose = "its own coordinate system" if grid[at] else f"that of GRDSET, {given}"
                raise ResourceError(f"GRID {label} has {whose}; use the basic one")
        if not np.array_equal(found.setdefault(label, position), position):
            raise ResourceError(f"GRID {label} stands twice, at two places")
    return found


def _read_dmig(fields: list[str], matrices: dict[str, _Matrix]) -> None:
    """Header or elements; of matrices that are neither stiffness nor mass the name alone."""
    name = fields[0].upper()
    if fields[1] == "0":
        matrices.setdefault(name, _Matrix(_integer(fields[2]), _integer(fields[3]), {}))
        return
    if name not in matrices:
        raise ResourceError(f"DMIG {name} has no header card (second field 0)")
    if not name.startswith(("K", "M")):
        return
    elements = matrices[name].elements
    column = (whole(fields[1]), _integer(fields[2]))
    for at in range(4, len(fields) - 2, 4):
        if fields[at]:
            row = (whole(fields[at]), _integer(fields[at + 1]))
            if (row, column) in elements:
                raise ResourceError(f"DMIG {name}: {_element(row, column)} is given twice")
            elements[row, column] = _real(fields[at + 2])


def _symmetric(
    matrices: dict[str, _Matrix], letter: str, path: Path
) -> dict[tuple[Row, Row], float]:
    """Elements of the one matrix that begins with a letter; raises ResourceError if not usable."""
    name = only_name(list(matrices), letter, path)
    form, kind, elements = matrices[name]
    if form != _SYMMETRIC or kind not in _REAL:
        raise ResourceError(
            f"{path}: DMIG {name} has form {form}, type {kind}; form 6 (symmetric) and type 1 or 2 "
            "(real) are read"
        )
    _check_symmetric(elements, f"{path}: DMIG {name}")
    return elements


def _element(row: Row, column: Row) -> str:
    return f"the element in row {row[0]},{row[1]} and column {column[0]},{column[1]} (grid,axis)"


def _check_symmetric(matrix: dict[tuple[Row, Row], float], where: str) -> None:
    """Refuse elements that are given on both sides of the diagonal and differ."""
    for (row, column), value in matrix.items():
        other = matrix.get((column, row), value)
        if not math.isclose(value, other, rel_tol=_SAME):
            raise ResourceError(
                f"{where}: {_element(row, column)} is {value:g}, its transpose {other:g}; "
                "form 6 is symmetric: give one of them"
            )


def _assemble(matrix: dict[tuple[Row, Row], float], rows: list[Row]) -> sp.csr_array:
    """The full matrix; a symmetric entry is given on either side of the diagonal, or on both."""
    at = {row: i for i, row in enumerate(rows)}
    found = sp.dok_array((len(rows), len(rows)))
    for (row, column), value in matrix.items():
        found[at[row], at[column]] = found[at[column], at[row]] = value
    return found.tocsr()

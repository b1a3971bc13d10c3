"""The table of a results folder: in pieces, its end, or mapped into memory."""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import numpy as np
import pandas as pd

from herringbone.core import ResourceError
from herringbone.core.errors import reason
from herringbone.result.folder.names import OTHERS, ROWS
from herringbone.result.folder.others import counted_others, read_others
from herringbone.result.folder.rows import counted_rows, mapped_rows, read_rows
from herringbone.result.tables import PIECE

_KEPT = 64 << 20
"""Bytes of the last rows of a long run, of which figures are taken."""
_OVERVIEW = 8192
"""Rows of an overview at the least."""


@dataclass(frozen=True)
class StoredTable:
    """Rows of a folder.

    Attributes:
        folder: where they are.
        columns: of reals, the time first.
        others: types of the other columns by name.
        rows: number of rows.
    """

    folder: Path
    columns: Sequence[str]
    others: Mapping[str, str]
    rows: int

    @property
    def kept(self) -> int:
        """Number of last rows that fit into a part of the memory."""
        return min(self.rows, max(2, _KEPT // (8 * len(self.columns))))

    def last(self, rows: int) -> pd.DataFrame:
        """The last rows, in memory; raises HerringboneError."""
        first = self.rows - rows
        values = read_rows(self.folder / ROWS, len(self.columns), first, self.rows)
        return self._frame(values, self._others(first))

    def before(self, rows: int) -> pd.DataFrame:
        """Reals of the records before the last rows, read when they are used."""
        values = mapped_rows(self.folder / ROWS, len(self.columns), self.rows - rows)
        return self._frame(values, {}, copy=False)

    def all(self) -> pd.DataFrame:
        """All rows; reals of long runs are read when they are used. Raises HerringboneError."""
        if self.rows <= self.kept:
            return self.last(self.rows)
        values = mapped_rows(self.folder / ROWS, len(self.columns), self.rows)
        return self._frame(values, self._others(0), copy=False)

    def _others(self, first: int) -> dict[str, np.ndarray]:
        if not self.others:
            return {}
        return read_others(self.folder / OTHERS, self.others, first, self.rows)

    def _frame(
        self, values: np.ndarray, others: Mapping[str, np.ndarray], *, copy: bool = True
    ) -> pd.DataFrame:
        """As the table of a run: copied, so that its means are summed in the same order."""
        data = pd.DataFrame(values, columns=list(self.columns), copy=copy)
        if not others:
            return data
        return pd.concat([data, pd.DataFrame(dict(others))], axis=1)

    def reals(self, piece: int = PIECE) -> Iterator[np.ndarray]:
        """Rows of reals, the time first, piece by piece; raises HerringboneError."""
        for first in range(0, self.rows, piece):
            last = min(first + piece, self.rows)
            yield read_rows(self.folder / ROWS, len(self.columns), first, last)

    def pieces(self) -> Iterator[pd.DataFrame]:
        """All columns, piece by piece; raises HerringboneError."""
        if not self.rows:
            yield self.last(0)
            return
        others = self._other_pieces() if self.others else iter(dict, None)
        for values, more in zip(self.reals(), others, strict=False):
            yield self._frame(values, more, copy=False)

    def _other_pieces(self) -> Iterator[dict[str, np.ndarray]]:
        file = self.folder / OTHERS
        try:
            with file.open("rb") as stream:
                for first in range(0, self.rows, PIECE):
                    lines = islice(stream, min(PIECE, self.rows - first))
                    columns = zip(*map(json.loads, lines), strict=True)
                    pairs = zip(self.others.items(), columns, strict=True)
                    yield {name: np.array(column, dtype=kind) for (name, kind), column in pairs}
        except (OSError, ValueError, TypeError) as error:
            raise ResourceError(f"cannot read {file}: {reason(error)}") from error

    def overview(self) -> pd.DataFrame:
        """Smallest and largest values of pieces of the run, by turns, with the pieces' times."""
        size = max(1, self.rows // (_OVERVIEW // 2))
        rows: list[np.ndarray] = []
        for values in self.reals(size):
            low, high = values.min(axis=0), values.max(axis=0)
            rows += [low, high]
        return pd.DataFrame(np.array(rows), columns=list(self.columns))


def stored_table(folder: Path, columns: Sequence[str], others: Mapping[str, str]) -> StoredTable:
    """The table that a folder has at this moment.

    Rows whose time does not follow, which a machine that lost its power may leave, are none.

    Raises:
        ResourceError: it has none, or another one.
    """
    rows = counted_rows(folder / ROWS, len(columns))
    if others:
        rows = min(rows, counted_others(folder / OTHERS))
    while rows > 1:
        before, last = read_rows(folder / ROWS, len(columns), rows - 2, rows)[:, 0]
        if last > before:
            break
        rows -= 1
    return StoredTable(folder, columns, others, rows)

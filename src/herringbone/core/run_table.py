"""The columns of a run's table, and who takes its rows while the run goes on."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np


class TableColumns(NamedTuple):
    """Columns beside the time.

    Attributes:
        names: of reals, `instance.variable`.
        units: of each of these, "" if not declared.
        others: types of the columns of other types, as NumPy calls them, by name.
        other_units: units of these.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    others: Mapping[str, str]
    other_units: Mapping[str, str]


class KeptRows(NamedTuple):
    """The last rows of a run.

    Attributes:
        time: (n,) [s].
        values: (n, m), columns as `TableColumns.names`.
        others: (n,) by name.
    """

    time: np.ndarray
    values: np.ndarray
    others: Mapping[str, np.ndarray]


class RowSink(Protocol):
    """Where the rows of a run go, in their order, while it goes on."""

    def begin(self, columns: TableColumns, rows: int) -> None:
        """The run has these columns, and will have so many rows; 0: nobody knows how many.

        Raises:
            HerringboneError: they cannot be kept.
        """

    def append(
        self, times: np.ndarray, values: np.ndarray, others: Sequence[Sequence[Any]]
    ) -> None:
        """Take the next rows.

        Args:
            times: (n,) [s].
            values: (n, m).
            others: n rows of other types, bytes as hexadecimal digits; empty without such columns.

        Raises:
            HerringboneError: they cannot be kept.
        """

    def cut(self, rows: int) -> None:
        """Keep the first rows of the run only."""

    def checkpoint(self, state: Mapping[str, np.ndarray]) -> None:
        """Keep the state of the run after the rows so far; raises HerringboneError."""

    def read(self) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """All rows again: times and values, piece by piece."""

    def kept(self) -> KeptRows:
        """The last rows, as many as fit into a part of the memory."""

"""The tidy table of a study: a row per point, in pieces that memory holds whatever there is."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from herringbone.result.folder.names import UNITS
from herringbone.result.folder.writing import replacing
from herringbone.result.tables import parquet_library, write_csv, write_parquet, write_units
from herringbone.studies.keys import Chain
from herringbone.studies.store import StudyFolder
from herringbone.studies.study import Study

TABLE, PARQUET = "table.csv", "table.parquet"
_POINT, _OUTCOME, _MESSAGE = "point", "outcome", "message"
_ROWS_IN_PIECE = 4096


@dataclass(frozen=True)
class StudyTable:
    """The table of chains that are all there.

    Attributes:
        study, chains, store: of the study.
        given: units of the parameters.
        figures: units of the columns that follow parameters and outcome.
    """

    study: Study
    chains: Sequence[Chain]
    store: StudyFolder
    given: Mapping[str, str]
    figures: Mapping[str, str]

    @property
    def columns(self) -> list[str]:
        """All columns, in order."""
        return [_POINT, *self.study.names, _OUTCOME, _MESSAGE, *self.figures]

    @property
    def units(self) -> dict[str, str]:
        """Unit by column; of texts and pure numbers ""."""
        return {_POINT: "", **self.given, _OUTCOME: "", _MESSAGE: "", **self.figures}

    def pieces(self) -> Iterator[pd.DataFrame]:
        """The rows, in pieces."""
        names = self.study.names
        texts = {
            name
            for k, name in enumerate(names)
            if any(isinstance(point[k], str) for point in self.study.points)
        }
        rows: list[list] = []
        for chain, done in self.store.all(list(self.chains)):
            for number, row in zip(chain.numbers, done.rows, strict=True):
                figures = [row.figures.get(name, np.nan) for name in self.figures]
                values = self.study.points[number]
                rows.append([number, *values, row.outcome, row.message, *figures])
            if len(rows) >= _ROWS_IN_PIECE:
                yield self._frame(rows, texts)
                rows = []
        if rows:
            yield self._frame(rows, texts)

    def _frame(self, rows: list[list], texts: set[str]) -> pd.DataFrame:
        frame = pd.DataFrame(rows, columns=self.columns)
        as_text = {name: str for name in texts}
        as_number = {name: float for name in self.figures}
        return frame.astype({**as_text, **as_number})

    def write(self, folder: Path, *, parquet: bool) -> list[Path]:
        """Write the table and its units; returns the files.

        Raises:
            HerringboneError: a file cannot be written, or pyarrow is not installed.
        """
        if parquet:
            parquet_library()
        files = [folder / UNITS, folder / TABLE]
        with replacing(files[0]) as stream:
            write_units(stream, self.units)
        with replacing(files[1]) as stream:
            write_csv(stream, self.columns, self.pieces())
        if parquet:
            files.append(folder / PARQUET)
            with replacing(files[2], text=False) as stream:
                write_parquet(stream, self.pieces())
        return files

    def whole(self) -> pd.DataFrame:
        """All rows in memory."""
        return pd.concat(list(self.pieces()), ignore_index=True)


def study_table(
    study: Study, chains: Sequence[Chain], store: StudyFolder, given: Mapping[str, str]
) -> StudyTable:
    """The table; its columns are all figures that a point has, in the order in which they come."""
    figures: dict[str, str] = {}
    for _, done in store.all(list(chains)):
        for name, unit in done.units.items():
            figures.setdefault(name, unit)
    return StudyTable(study, chains, store, given, figures)

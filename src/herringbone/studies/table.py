"""The tidy table of a study: a row per point."""

import csv
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from herringbone.core import ResourceError
from herringbone.core.facts import Facts
from herringbone.core.places.files import is_file
from herringbone.result.folder.names import STUDY_PARQUET, STUDY_TABLE, UNITS
from herringbone.result.folder.writing import replacing
from herringbone.result.tables import (
    as_numbers,
    parquet_library,
    pieces_of,
    write_csv,
    write_parquet,
    write_units,
)
from herringbone.studies.keys import Chain
from herringbone.studies.store import StudyFolder
from herringbone.studies.study import Study
from herringbone.studies.working.chain import Done

_POINT, _OUTCOME, _MESSAGE = "point", "outcome", "message"
_ROWS_IN_PIECE = 4096


@dataclass(frozen=True, repr=False)
class StudyTable(Facts):
    """The table of a study's points.

    Attributes:
        data: a row per point.
        units: by column; of texts and pure numbers "".
    """

    data: pd.DataFrame
    units: Mapping[str, str]

    def _facts(self) -> dict[str, str]:
        return {"points": str(len(self.data)), "table": f"{len(self.data.columns)} columns"}

    def write(self, folder: Path, *, parquet: bool) -> list[Path]:
        """Write the table and its units; returns the files.

        A Parquet table of before, which may be another one, does not stay.

        Raises:
            HerringboneError: a file cannot be written, or pyarrow is not installed.
        """
        if parquet:
            parquet_library()
        files = [folder / UNITS, folder / STUDY_TABLE]
        with replacing(files[0]) as stream:
            write_units(stream, self.units)
        with replacing(files[1]) as stream:
            write_csv(stream, list(self.data.columns), pieces_of(self.data))
        if parquet:
            files.append(folder / STUDY_PARQUET)
            with replacing(files[2], text=False) as stream:
                write_parquet(stream, pieces_of(self.data))
        else:
            (folder / STUDY_PARQUET).unlink(missing_ok=True)
        return files


def read_table(folder: str | Path) -> StudyTable:
    """The table in a folder that `herringbone sweep` has written, bit by bit.

    Args:
        folder: of the sweep.

    Raises:
        ResourceError: it has no table, or that is damaged.
    """
    folder = Path(folder)
    if not is_file(folder / STUDY_TABLE):
        raise ResourceError(
            f"{folder} has no {STUDY_TABLE}: it holds no sweep, or one that was cut off; the same "
            "sweep into this folder goes on"
        )
    try:
        texts = pd.read_csv(folder / STUDY_TABLE, dtype=str, keep_default_na=False)
        data = texts.apply(as_numbers).astype({_POINT: int})
        with (folder / UNITS).open(encoding="utf-8", newline="") as stream:
            rows = [row for row in csv.reader(stream) if len(row) == 2][1:]
    except (OSError, ValueError, KeyError) as error:
        raise ResourceError(f"{folder}: its table is damaged: {error}") from error
    return StudyTable(data, {name: "" if unit == "1" else unit for name, unit in rows})


def study_table(
    study: Study,
    chains: Sequence[Chain],
    store: StudyFolder,
    given: Mapping[str, str],
    *,
    whole: bool = True,
) -> StudyTable:
    """The table; its columns are all figures that a point has, in the order in which they come.

    Each chain is read once.

    Args:
        study, chains, store: of the study.
        given: units of the parameters.
        whole: all chains are there; else the points that are there so far, at least one.
    """
    figures: dict[str, str] = {}
    pieces = list(_pieces(study, store.all(list(chains), whole=whole), figures))
    own = [_POINT, *study.names, _OUTCOME, _MESSAGE]
    units = {_POINT: "", **given, _OUTCOME: "", _MESSAGE: "", **figures}
    data = pd.concat([piece.reindex(columns=[*own, *figures]) for piece in pieces])
    texts = {name: str for k, name in enumerate(study.names) if _has_text(study, k)}
    data = data.astype({**texts, **dict.fromkeys(figures, float)})
    return StudyTable(data.reset_index(drop=True), units)


def _has_text(study: Study, parameter: int) -> bool:
    return any(isinstance(point[parameter], str) for point in study.points)


def _pieces(
    study: Study, found: Iterable[tuple[Chain, Done]], figures: dict[str, str]
) -> Iterator[pd.DataFrame]:
    """Rows with the figures that are known so far, to which those of each chain are added."""
    rows: list[list] = []
    for chain, done in found:
        for name, unit in done.units.items():
            figures.setdefault(name, unit)
        for number, row in zip(chain.numbers, done.rows, strict=True):
            own = [row.figures.get(name, np.nan) for name in figures]
            rows.append([number, *study.points[number], row.outcome, row.message, *own])
        if len(rows) >= _ROWS_IN_PIECE:
            yield _frame(study, rows, figures)
            rows = []
    if rows:
        yield _frame(study, rows, figures)


def _frame(study: Study, rows: list[list], figures: Mapping[str, str]) -> pd.DataFrame:
    """A piece; the first rows may lack figures that came later."""
    columns = [_POINT, *study.names, _OUTCOME, _MESSAGE, *figures]
    whole = [row + [np.nan] * (len(columns) - len(row)) for row in rows]
    return pd.DataFrame(whole, columns=columns)

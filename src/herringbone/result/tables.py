"""A table as CSV or Parquet, written piece by piece."""

import csv
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import IO, Any

import numpy as np
import orjson
import pandas as pd

from herringbone.core import HerringboneError

PIECE = 4096
"""Rows that are turned into text at a time."""


def pieces_of(data: pd.DataFrame) -> Iterator[pd.DataFrame]:
    """A table in pieces; one of no rows is one piece."""
    for first in range(0, max(len(data), 1), PIECE):
        yield data.iloc[first : first + PIECE]


def write_csv(
    stream: IO[str],
    columns: Sequence[str],
    pieces: Iterable[pd.DataFrame],
    units: Mapping[str, str] | None = None,
) -> None:
    """Write a table: a header row, and rows that read back bit by bit.

    Args:
        stream: a text file, lines as they are.
        columns: names.
        pieces: of the table, all with these columns.
        units: by column, for a first line that begins with `# units:`; None for none.
    """
    if units is not None:
        listed = ", ".join(f"{name} {units[name] or '1'}" for name in columns)
        stream.write(f"# units: {listed}\n")
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(columns)
    for piece in pieces:
        if (piece.dtypes == np.float64).all():
            stream.write(_text_of(np.ascontiguousarray(piece.to_numpy(dtype=float))))
        else:
            writer.writerows(zip(*(piece[name].tolist() for name in columns), strict=True))


def records_of(table: pd.DataFrame) -> list[dict[str, Any]]:
    """Rows of a table for JSON, with all digits; what is not finite is None."""
    return [
        {k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in row.items()}
        for row in table.to_dict("records")
    ]


def as_numbers(column: pd.Series) -> pd.Series:
    """The column as numbers, bit by bit, if all of them are."""
    try:
        return column.astype(float)
    except ValueError:
        return column


def _text_of(rows: np.ndarray) -> str:
    """Rows (n, m) as lines of the shortest numbers that read back bit by bit."""
    if not rows.size or not np.isfinite(rows).all():  # which JSON has no words for
        return "".join([",".join(map(repr, row)) + "\n" for row in rows.tolist()])
    text = orjson.dumps(rows, option=orjson.OPT_SERIALIZE_NUMPY)
    return text[2:-2].replace(b"],[", b"\n").decode("ascii") + "\n"


def write_units(stream: IO[str], units: Mapping[str, str]) -> None:
    """Write the unit of each column as a CSV table."""
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["column", "unit"])
    writer.writerows((name, unit or "1") for name, unit in units.items())


def write_parquet(file: str | Path | IO[bytes], pieces: Iterable[pd.DataFrame]) -> None:
    """Write a table as Parquet, a group of rows per piece.

    Raises:
        HerringboneError: pyarrow is not installed.
    """
    pyarrow, parquet = parquet_library()
    writer: Any = None
    try:
        for piece in pieces:
            table = pyarrow.Table.from_pandas(piece, preserve_index=False)
            if writer is None:
                writer = parquet.ParquetWriter(file, table.schema)
            writer.write_table(table.cast(writer.schema))
    finally:
        if writer is not None:
            writer.close()


def parquet_library() -> tuple[Any, Any]:
    """pyarrow and its module for Parquet.

    Raises:
        HerringboneError: it is not installed.
    """
    try:
        return import_module("pyarrow"), import_module("pyarrow.parquet")
    except ImportError as error:
        raise HerringboneError(
            "Parquet needs pyarrow; install it with: pip install 'herringbone[tables]'"
        ) from error

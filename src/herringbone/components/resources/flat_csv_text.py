"""Writer of the flat CSV files that `flat_csv` reads."""

from collections.abc import Iterable
from typing import Any

from herringbone.components.resources.flat_csv import read_flat_csv
from herringbone.core import Column
from herringbone.core.reading.texts import AnyPath


def flat_csv_text(units: str, header: Iterable[str], rows: Iterable[Iterable[Any]]) -> str:
    """A flat CSV text; numbers have as many digits as it takes to read them back exactly.

    Args:
        units: `column unit, ...`.
        header: names of the columns.
        rows: numbers, and words without commas.
    """
    lines = [f"# units: {units}", ",".join(header)]
    for row in rows:
        cells = (
            v if isinstance(v, str) else repr(v if isinstance(v, int) else float(v)) for v in row
        )
        lines.append(",".join(cells))
    return "\n".join(lines) + "\n"


def with_scaled_column(
    file: AnyPath, columns: tuple[Column, ...], column: str, factor: float
) -> str:
    """Text of a flat CSV file with the numbers of one column multiplied; comments are left out.

    Args:
        file: the file.
        columns: that it has.
        column: one of numbers.
        factor: by which it is multiplied.

    Raises:
        ResourceError: see `read_flat_csv`.
    """
    words = tuple(c.name for c in columns if c.words)
    table, units = read_flat_csv(file, words, {c.name: c.units for c in columns if c.units})
    table[column] = factor * table[column]
    said = ", ".join(f"{name} {unit}" for name, unit in units.items())
    return flat_csv_text(said, table, zip(*table.values(), strict=True))

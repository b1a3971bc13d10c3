"""The flat CSV files that FMUs read: one `# units:` line, a header row, then rows.

# units: load N, phase 1, stiffness N/m
side,load,phase,stiffness
left,56.306,0.0,8.22e8
"""

import csv
import zipfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from herringbone.core import ResourceError, reason

TablePath = Path | zipfile.Path


def _units(line: str, file: TablePath) -> dict[str, str]:
    before, _, text = line.partition("# units:")
    if before or not text:
        raise ResourceError(f"{file}: the first line must be '# units: <column> <unit>, ...'")
    return dict(item.split(maxsplit=1) for item in text.strip().split(",") if len(item.split()) > 1)


def check_units(
    found: Mapping[str, str], wanted: Mapping[str, tuple[str, ...]], file: TablePath
) -> None:
    """Check the units of columns; raises ResourceError."""
    for column, units in wanted.items():
        unit = found.get(column, "").strip()
        if unit not in units:
            raise ResourceError(
                f"{file}: column '{column}' has unit '{unit or 'none'}' in the '# units:' line; "
                f"it takes {' or '.join(units)}"
            )


def read_flat_csv(
    file: TablePath,
    texts: tuple[str, ...],
    numbers: Mapping[str, tuple[str, ...]],
    *,
    more: str = "",
) -> tuple[dict[str, np.ndarray], dict[str, str]]:
    """Read a flat CSV file.

    Args:
        file: the file.
        texts: columns of text.
        numbers: columns of numbers, with the units that each may have.
        more: if given, all further columns are numbers with the unit that stands under this name.

    Returns:
        Columns by name, and the unit of each column of numbers.

    Raises:
        ResourceError: not readable, wrong unit, missing column, or a value that is not finite.
    """
    try:
        lines = file.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise ResourceError(f"cannot read {file}: {reason(error)}") from error
    units = _units(lines[0] if lines else "", file)
    check_units(units, numbers, file)
    rows = [(n, r) for n, r in enumerate(csv.reader(lines), 1) if r and not r[0].startswith("#")]
    if len(rows) < 2:
        raise ResourceError(f"{file}: it has no rows")
    header = [name.strip() for name in rows[0][1]]
    if twice := sorted({name for name in header if header.count(name) > 1}):
        raise ResourceError(f"{file}: column {', '.join(twice)} stands twice")
    missing = [name for name in (*texts, *numbers) if name not in header]
    if missing:
        raise ResourceError(
            f"{file}: column {', '.join(missing)} is missing; it has {', '.join(header)}"
        )
    extra = [name for name in header if name not in texts and name not in numbers]
    if extra and not more:
        raise ResourceError(f"{file}: column {', '.join(extra)} is unknown")
    columns: dict[str, list] = {name: [] for name in header}
    for line, row in rows[1:]:
        if len(row) != len(header):
            raise ResourceError(f"{file}, line {line}: {len(row)} fields, {len(header)} expected")
        for name, text in zip(header, row, strict=True):
            columns[name].append(text.strip() if name in texts else _number(text, name, file, line))
    return {name: np.array(values) for name, values in columns.items()}, units


def read_header(file: TablePath, name: str, count: int) -> np.ndarray:
    """Numbers of the comment line `# name: ...` of a flat CSV file; the last such line counts.

    Returns:
        (count,), NaN if the file has no such line.

    Raises:
        ResourceError: it has not that many finite numbers.
    """
    mark, last = f"# {name}:", 0
    lines = file.read_text(encoding="utf-8-sig").splitlines() if count else []
    for line, text in enumerate(lines, 1):
        last = line if text.startswith(mark) else last
    if last == 0:
        return np.full(count, np.nan)
    try:
        found = np.array([float(word) for word in lines[last - 1].removeprefix(mark).split()])
    except ValueError:
        found = np.empty(0)
    if len(found) != count or not np.isfinite(found).all():
        raise ResourceError(f"{file}, line {last}: '{mark}' takes {count} finite numbers")
    return found


def _number(text: str, column: str, file: TablePath, line: int) -> float:
    try:
        value = float(text)
    except ValueError:
        value = np.nan
    if not np.isfinite(value):
        raise ResourceError(f"{file}, line {line}: {column} = '{text}' is not a finite number")
    return value

"""The flat CSV files that FMUs read: one `# units:` line, a header row, then rows.

# units: load N, phase 1, stiffness N/m
side,load,phase,stiffness
left,56.306,0.0,8.22e8
"""

import re
from collections.abc import Mapping
from itertools import takewhile

import numpy as np

from herringbone.core import ResourceError
from herringbone.core.caching.remembered import Remembered
from herringbone.core.reading.numbers import number
from herringbone.core.reading.texts import AnyPath, lines_of, read_text, text_key

_Table = tuple[dict[str, np.ndarray], dict[str, str]]
_tables: Remembered[_Table] = Remembered(64)
_headers: Remembered[np.ndarray] = Remembered(64)
_SECTION = "# section: "
_BLANK = " \t\v\f"
_QUOTED = re.compile(r'"((?:[^"]++|"")*+)"([^,]*)')
_PLAIN = re.compile(r"()([^,]*)")


def _units(line: str, file: AnyPath) -> dict[str, str]:
    before, _, text = line.partition("# units:")
    if before or not text:
        raise ResourceError(f"{file}: the first line must be '# units: <column> <unit>, ...'")
    return dict(item.split(maxsplit=1) for item in text.strip().split(",") if len(item.split()) > 1)


def check_units(
    found: Mapping[str, str], wanted: Mapping[str, tuple[str, ...]], file: AnyPath
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
    file: AnyPath,
    texts: tuple[str, ...],
    numbers: Mapping[str, tuple[str, ...]],
    *,
    more: str = "",
    section: str = "",
) -> tuple[dict[str, np.ndarray], dict[str, str]]:
    """Read a flat CSV file.

    Args:
        file: the file.
        texts: columns of text.
        numbers: columns of numbers, with the units that each may have.
        more: if given, all further columns are numbers with the unit that stands under this name.
        section: what is read lies behind the line `# section: ...`, up to the next such line;
            "": it is the whole file.

    Returns:
        Columns by name, and the unit of each column of numbers.

    Raises:
        ResourceError: not readable, wrong unit, missing column, or a value that is not finite.
    """
    key = text_key(file)
    if not key:
        return _read(file, texts, numbers, more, section)
    asked = key, texts, tuple(numbers.items()), more, section
    columns, units = _tables(asked, lambda: _read(file, texts, numbers, more, section))
    return {name: values.copy() for name, values in columns.items()}, dict(units)


def _section(file: AnyPath, section: str) -> tuple[int, list[str]]:
    """Number of the first line of a section in the file, and its lines; raises ResourceError."""
    lines = lines_of(read_text(file))
    if not section:
        return 1, lines
    mark = _SECTION + section
    if mark not in lines:
        raise ResourceError(f"{file}: it has no line '{mark}'")
    first = lines.index(mark) + 1
    inside = list(takewhile(lambda line: not line.startswith(_SECTION), lines[first:]))
    return first + 1, inside


def _read(
    file: AnyPath,
    texts: tuple[str, ...],
    numbers: Mapping[str, tuple[str, ...]],
    more: str,
    section: str,
) -> _Table:
    """See `read_flat_csv`."""
    first, lines = _section(file, section)
    units = _units(lines[0] if lines else "", file)
    rows = [
        (n, fields_of(line, file, n))
        for n, line in enumerate(lines, first)
        if line and not line.startswith("#")
    ]
    if len(rows) < 2:
        raise ResourceError(f"{file}: it has no rows")
    header = [name.strip(_BLANK) for name in rows[0][1]]
    if twice := sorted({name for name in header if header.count(name) > 1}):
        raise ResourceError(f"{file}: column {', '.join(twice)} stands twice")
    missing = [name for name in (*texts, *numbers) if name not in header]
    if missing:
        raise ResourceError(
            f"{file}: column {', '.join(missing)} is missing; it has "
            f"{', '.join(filter(None, header))}"
        )
    extra = [name for name in header if name not in texts and name not in numbers]
    if extra and not more:
        raise ResourceError(f"{file}: column {', '.join(filter(None, extra))} is unknown")
    check_units(units, numbers, file)
    columns: dict[str, list] = {name: [] for name in header}
    for line, row in rows[1:]:
        if len(row) != len(header):
            raise ResourceError(f"{file}, line {line}: {len(row)} fields, {len(header)} expected")
        for name, text in zip(header, row, strict=True):
            columns[name].append(
                text.strip(_BLANK) if name in texts else _number(text, name, file, line)
            )
    return {name: np.array(values) for name, values in columns.items()}, units


def read_header(file: AnyPath, name: str, count: int, section: str = "") -> np.ndarray:
    """Numbers of the comment line `# name: ...` of a flat CSV file; the last such line counts.

    Returns:
        (count,), NaN if the file has no such line.

    Raises:
        ResourceError: it has not that many finite numbers.
    """
    key = text_key(file)
    if not (key and count):
        return _read_header(file, name, count, section)
    asked = key, name, count, section
    return _headers(asked, lambda: _read_header(file, name, count, section)).copy()


def _read_header(file: AnyPath, name: str, count: int, section: str) -> np.ndarray:
    """See `read_header`."""
    mark, last = f"# {name}:", 0
    first, lines = _section(file, section) if count else (1, [])
    for line, text in enumerate(lines, first):
        last = line if text.startswith(mark) else last
    if last == 0:
        return np.full(count, np.nan)
    words = lines[last - first].removeprefix(mark).split()
    try:
        found = np.array([number(word) for word in words])
    except ValueError:
        found = np.empty(0)
    if len(found) != count:
        raise ResourceError(f"{file}, line {last}: '{mark}' takes {count} finite numbers")
    return found


def _number(text: str, column: str, file: AnyPath, line: int) -> float:
    try:
        return number(text)
    except ValueError:
        said = f"{file}, line {line}: {column} = '{text[:64]}' is not a finite number"
        raise ResourceError(said) from None


def fields_of(line: str, file: AnyPath, n: int = 1) -> list[str]:
    """Fields of line n; quotes around one are taken off, and two inside stand for one.

    Raises:
        ResourceError: a quote is not closed.
    """
    if '"' not in line:
        return line.split(",")
    fields, at = [], 0
    while at <= len(line):
        found = (_QUOTED if line.startswith('"', at) else _PLAIN).match(line, at)
        if found is None:
            raise ResourceError(f"{file}, line {n}: a quote is not closed")
        fields.append(found[1].replace('""', '"') + found[2])
        at = found.end() + 1
    return fields

"""File of tooth deviations: CSV, one row per tooth of both gears, in metres.

    # herringbone tooth deviations 1.1, unit m
    gear,tooth,cumulative_pitch,run_out,profile_slope,helix_slope,coast_cumulative_pitch,...
    pinion,1,2.1e-06,...

The columns coast_cumulative_pitch, coast_profile_slope and coast_helix_slope are those of the coast
flanks, the others those of the drive flanks. A file "1.0" ends with helix_slope: of its coast
flanks nothing is known. What the columns mean, and how teeth are counted: `deviations`. The single
pitch deviation is the difference of neighbours. A double-helical pair has a file for each half.
"""

import math
from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path

import numpy as np

from herringbone.core import HerringboneError, ResourceError
from herringbone.core.places.files import write_whole
from herringbone.core.reading.numbers import number
from herringbone.core.reading.texts import lines_of, read_text
from herringbone.gears.accuracy.deviations import ToothDeviations
from herringbone.gears.geometry.checks import GEARS
from herringbone.gears.geometry.gear_pair import GearPair

_HEADER = "# herringbone tooth deviations {}, unit m"
_VALUES = tuple(field.name for field in fields(ToothDeviations))
_COAST_VALUES = tuple(name for name in _VALUES if name != "run_out")
_DRIVE = ("gear", "tooth", *_VALUES)
_BOTH = (*_DRIVE, *(f"coast_{name}" for name in _COAST_VALUES))
_COLUMNS = {_HEADER.format("1.1"): _BOTH, _HEADER.format("1.0"): _DRIVE}
"""By the first line of a file."""
Teeth = tuple[ToothDeviations, ToothDeviations]
"""Of pinion and wheel."""
_LARGEST = 1e-2
"""Deviations [m] above it are of another unit."""


def write_deviations(
    deviations: Sequence[ToothDeviations],
    file: str | Path,
    coast: Sequence[ToothDeviations] | None = None,
) -> None:
    """Write the deviations of pinion and wheel.

    Args:
        deviations: of the drive flanks.
        file: to write.
        coast: of the coast flanks; None: not known.

    Raises:
        HerringboneError: the file cannot be written.
    """
    header, columns = list(_COLUMNS.items())[0 if coast else 1]
    lines = [header, ",".join(columns)]
    for gear, name in enumerate(GEARS):
        values = [getattr(deviations[gear], value) for value in _VALUES]
        if coast:
            values += [getattr(coast[gear], value) for value in _COAST_VALUES]
        rows = np.column_stack(values).tolist()
        lines += [
            f"{name},{tooth},{','.join(map(repr, row))}" for tooth, row in enumerate(rows, start=1)
        ]
    try:
        write_whole(Path(file), "\n".join(lines) + "\n")
    except OSError as error:
        raise HerringboneError(f"cannot write {file}: {error.strerror}") from error


def read_deviations(file: str | Path, pair: GearPair) -> tuple[Teeth, Teeth | None]:
    """Read the deviations of a pair's drive flanks, and of its coast flanks if they are there.

    Raises:
        ResourceError: not readable, another grammar, teeth missing or too many, or a value that is
            no number or no deviation.
    """
    columns, rows = _rows(file)
    found: dict[str, list[list[float]]] = {gear: [] for gear in GEARS}
    for line, row in enumerate(rows, start=3):
        if len(row) != len(columns) or row[0] not in found:
            raise ResourceError(f"{file} line {line}: a row is {','.join(columns)}")
        if row[1] != str(len(found[row[0]]) + 1):
            raise ResourceError(
                f"{file} line {line}: tooth {row[1]} of the {row[0]} where "
                f"{len(found[row[0]]) + 1} must follow"
            )
        found[row[0]].append([_value(item, f"{file} line {line}") for item in row[2:]])
    pinion, wheel = (
        _teeth(found[gear], teeth, f"{file}: {gear}")
        for gear, teeth in zip(GEARS, pair.number_of_teeth, strict=True)
    )
    drive = _drive(pinion), _drive(wheel)
    return drive, (_coast(pinion), _coast(wheel)) if columns is _BOTH else None


def _rows(file: str | Path) -> tuple[tuple[str, ...], list[list[str]]]:
    """Columns of a file, and its rows."""
    first, *lines = lines_of(read_text(Path(file))) or [""]
    rows = [line.split(",") for line in lines]
    columns = _COLUMNS.get(first.strip(), ())
    if not rows or tuple(rows[0]) != columns:
        known = " or ".join(f"'{head}' and {','.join(row)}" for head, row in _COLUMNS.items())
        raise ResourceError(f"{file}: a file of tooth deviations begins with {known}")
    return columns, rows[1:]


def _value(text: str, where: str) -> float:
    try:
        value = number(text)
    except ValueError:
        value = math.nan
    if not abs(value) <= _LARGEST:
        raise ResourceError(f"{where}: '{text}' is no deviation; give metres, at most {_LARGEST:g}")
    return value


def _teeth(rows: list[list[float]], teeth: int, where: str) -> dict[str, np.ndarray]:
    """The numbers of a gear by column."""
    if len(rows) != teeth:
        raise ResourceError(f"{where} has {len(rows)} rows; the pair's has {teeth} teeth")
    return dict(zip(_BOTH[2:], np.array(rows).T, strict=False))


def _drive(columns: dict[str, np.ndarray]) -> ToothDeviations:
    return ToothDeviations(**{name: columns[name] for name in _VALUES})


def _coast(columns: dict[str, np.ndarray]) -> ToothDeviations:
    values = {name: columns[f"coast_{name}"] for name in _COAST_VALUES}
    return ToothDeviations(run_out=columns["run_out"], **values)

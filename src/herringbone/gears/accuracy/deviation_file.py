"""File of tooth deviations: CSV, one row per tooth of both gears, in metres.

    # herringbone tooth deviations 1.0, unit m
    gear,tooth,cumulative_pitch,run_out,profile_slope,helix_slope
    pinion,1,2.1e-06,...

What the columns mean: `deviations`. The single pitch deviation is the difference of neighbours. A
double-helical pair has a file for each half.
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

_HEADER = "# herringbone tooth deviations 1.0, unit m"
_VALUES = tuple(field.name for field in fields(ToothDeviations))
_COLUMNS = ("gear", "tooth", *_VALUES)
_LARGEST = 1e-2
"""Deviations [m] above it are of another unit."""


def write_deviations(deviations: Sequence[ToothDeviations], file: str | Path) -> None:
    """Write the deviations of pinion and wheel.

    Raises:
        HerringboneError: the file cannot be written.
    """
    lines = [_HEADER, ",".join(_COLUMNS)]
    for gear, teeth in zip(GEARS, deviations, strict=True):
        rows = np.column_stack([getattr(teeth, name) for name in _VALUES]).tolist()
        lines += [
            f"{gear},{tooth},{','.join(map(repr, row))}" for tooth, row in enumerate(rows, start=1)
        ]
    try:
        write_whole(Path(file), "\n".join(lines) + "\n")
    except OSError as error:
        raise HerringboneError(f"cannot write {file}: {error.strerror}") from error


def read_deviations(file: str | Path, pair: GearPair) -> tuple[ToothDeviations, ToothDeviations]:
    """Read the deviations of a pair's pinion and wheel.

    Raises:
        ResourceError: not readable, another grammar, teeth missing or too many, or a value that is
            no number or no deviation.
    """
    first, *lines = lines_of(read_text(Path(file))) or [""]
    rows = [line.split(",") for line in lines]
    if first.strip() != _HEADER or not rows or tuple(rows[0]) != _COLUMNS:
        raise ResourceError(
            f"{file}: a file of tooth deviations begins with '{_HEADER}' and {','.join(_COLUMNS)}"
        )
    found: dict[str, list[list[float]]] = {gear: [] for gear in GEARS}
    for line, row in enumerate(rows[1:], start=3):
        if len(row) != len(_COLUMNS) or row[0] not in found:
            raise ResourceError(f"{file} line {line}: a row is {','.join(_COLUMNS)}")
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
    return pinion, wheel


def _value(text: str, where: str) -> float:
    try:
        value = number(text)
    except ValueError:
        value = math.nan
    if not abs(value) <= _LARGEST:
        raise ResourceError(f"{where}: '{text}' is no deviation; give metres, at most {_LARGEST:g}")
    return value


def _teeth(rows: list[list[float]], teeth: int, where: str) -> ToothDeviations:
    if len(rows) != teeth:
        raise ResourceError(f"{where} has {len(rows)} rows; the pair's has {teeth} teeth")
    return ToothDeviations(*np.array(rows).T)

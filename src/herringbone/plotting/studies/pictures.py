"""The pictures that a study's folder gets."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from herringbone.analysis.figures.sensitivity import (
    SENSITIVITY,
    base_value,
    given_sensitivities,
    sensitivities,
)
from herringbone.analysis.set_points import SPEED, TORQUE
from herringbone.analysis.steady.periodic import PeriodicMotion
from herringbone.analysis.steady.sensitivities.sensitivity import Sensitivity
from herringbone.core import ParameterError
from herringbone.core.names import file_name_for
from herringbone.plotting.studies.levels import Band, levels
from herringbone.plotting.studies.maps import is_map, level_map
from herringbone.plotting.studies.sensitivities import PARAMETER, band, tornado
from herringbone.plotting.studies.steady_state import steady_picture
from herringbone.plotting.studies.table import Points
from herringbone.plotting.studies.waterfall import waterfall

SPREAD = 1.0
"""Of parameters that nobody has measured, if nothing else is said: a factor of 2."""


class StudyPictures(NamedTuple):
    """What a study's folder got.

    Attributes:
        files: pictures.
        missing: a line on each picture that could not be drawn, and why.
    """

    files: list[Path]
    missing: list[str]


def write_study_pictures(
    table: pd.DataFrame,
    units: Mapping[str, str],
    folder: str | Path,
    title: str = "",
    spread: float = SPREAD,
) -> StudyPictures:
    """Write `levels.png`, and maps, waterfalls and tornado plots where the points allow them.

    Tornado plots are of parameters besides speed and torque that are varied, or whose sensitivities
    stand in the table, at the speed of the highest level; the band around the curves is what their
    spread makes of them.

    Args:
        table, units: see `plotting.studies.table`.
        folder: existing folder.
        title: of the pictures.
        spread: of parameters that are not varied: 1 if they are known within a factor of 2.

    Raises:
        HerringboneError: a file cannot be written.
    """
    points = Points(table, units, title)
    bands, tornados, missing = _uncertain(points, spread)
    wanted: dict[str, Callable[[], Figure]] = {"levels": partial(levels, points, bands=bands)}
    wanted |= {
        _named("tornado", group): partial(tornado, *given) for group, given in tornados.items()
    }
    if is_map(points):
        wanted["map"] = partial(level_map, points)
    if SPEED in points.numbers:
        for group in points.groups:
            wanted[_named("waterfall", group)] = partial(waterfall, points, group)
    files = []
    for name, draw in wanted.items():
        file = Path(folder) / f"{name}.png"
        try:
            figure = draw()
        except ParameterError as error:
            missing.append(f"no {file.name}: {error}")
            continue
        files.append(_written(figure, file))
    return StudyPictures(files, missing)


def write_steady_pictures(
    state: PeriodicMotion,
    found: Mapping[str, Mapping[str, Sensitivity]],
    folder: Path,
    spread: float = SPREAD,
) -> list[Path]:
    """Write `steady.png`, and `tornado.GROUP.png` of sensitivities by group and parameter.

    Raises:
        HerringboneError: a file cannot be written.
    """
    figures = {"steady": steady_picture(state)}
    for group, own in found.items():
        rows = [(name, each.relative, spread) for name, each in own.items()]
        frame = pd.DataFrame(rows, columns=[PARAMETER, "sensitivity", "spread"])
        figures[_named("tornado", group)] = tornado(frame, f"{group}.rms")
    return [_written(figure, folder / f"{name}.png") for name, figure in figures.items()]


def _named(kind: str, group: str) -> str:
    """Name of the picture of a group, which may be called by its unit."""
    return f"{kind}.{file_name_for(group)}"


def _written(figure: Figure, file: Path) -> Path:
    figure.savefig(file)
    return file


def _uncertain(
    points: Points, spread: float
) -> tuple[dict[str, Band], dict[str, tuple[pd.DataFrame, str]], list[str]]:
    """Bands of the levels over speed by group, what tornado plots of them show, what is missing."""
    own = [c for c in points.numbers if c not in {SPEED, TORQUE}]
    own = [c for c in own if (points.table[c].to_numpy(float) > 0.0).all()]
    bands: dict[str, Band] = {}
    tornados: dict[str, tuple[pd.DataFrame, str]] = {}
    missing: list[str] = []
    table = points.table
    if TORQUE in points.numbers:
        table = table[table[TORQUE] == table[TORQUE].max()]
    table = _middle(points, table, varied=own)
    middle = _middle(points, table)
    along = SPEED if SPEED in points.numbers else None
    for group in points.groups:
        level = f"{group}.rms"
        asked = any(c.startswith(f"{group}{SENSITIVITY}") for c in table)
        if not own and not asked:
            continue
        found = given_sensitivities(middle, group, spread, along)
        if own:
            varied = sensitivities(table, level, own, along)
            alone = found[~found[PARAMETER].isin(own)]
            found = pd.concat([part for part in (alone, varied) if len(part)] or [varied])
        none = f"no {_named('tornado', group)}.png: no point has a level and sensitivities of it"
        if not len(found) or not middle[level].notna().any():
            missing.append(none)
            continue
        if along is None:
            tornados[group] = found, level
            continue
        speed, values = middle[SPEED].to_numpy(float), middle[level].to_numpy(float)
        known = np.isin(speed, found[SPEED].to_numpy(float)) & np.isfinite(values)
        if not known.any():
            missing.append(none)
            continue
        bands[group] = band(speed, values, found, SPEED)
        at = float(speed[known][np.nanargmax(values[known])])
        tornados[group] = found[found[SPEED] == at], f"{level} at {at:g} r/min"
    return bands, tornados, missing


def _middle(points: Points, table: pd.DataFrame, varied: Sequence[str] = ()) -> pd.DataFrame:
    """Rows along the speed at which all other parameters but some have their base values."""
    for name in points.parameters:
        if name in {SPEED, TORQUE, *varied}:
            continue
        values = table[name]
        base = base_value(values) if name in points.numbers else values.iloc[0]
        table = table[values == base]
    return table.sort_values(SPEED) if SPEED in points.numbers else table

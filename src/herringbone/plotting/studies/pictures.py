"""The pictures that a study's folder gets."""

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from herringbone.analysis.figures.sensitivity import base_value, sensitivities
from herringbone.analysis.set_points import SPEED, TORQUE
from herringbone.core import HerringboneError, ParameterError
from herringbone.plotting.studies.levels import Band, levels, waterfall
from herringbone.plotting.studies.maps import is_map, level_map
from herringbone.plotting.studies.sensitivities import band, tornado
from herringbone.plotting.studies.table import Points


def write_study_pictures(
    table: pd.DataFrame, units: Mapping[str, str], folder: str | Path, title: str = ""
) -> list[Path]:
    """Write `levels.png`, and maps, waterfalls and tornado plots where the points allow them.

    Tornado plots are of parameters besides speed and torque, at the speed of the highest level; the
    band around the curves is what their spread makes of them.

    Args:
        table, units: see `plotting.studies.table`.
        folder: existing folder.
        title: of the pictures.

    Returns:
        The files; none of a table without a parameter that is varied or without levels.

    Raises:
        HerringboneError: a file cannot be written.
    """
    points = Points(table, units, title)
    bands, tornados = _uncertain(points)
    wanted: dict[str, Callable[[], Figure]] = {"levels": partial(levels, points, bands=bands)}
    wanted |= {f"tornado.{group}": partial(tornado, *given) for group, given in tornados.items()}
    if is_map(points):
        wanted["map"] = partial(level_map, points)
    if SPEED in points.numbers:
        for group in points.groups:
            wanted[f"waterfall.{group}"] = partial(waterfall, points, group)
    files = []
    for name, draw in wanted.items():
        try:
            figure = draw()
        except ParameterError:
            continue
        file = Path(folder) / f"{name}.png"
        try:
            figure.savefig(file)
        except OSError as error:
            raise HerringboneError(f"cannot write {file}: {error.strerror}") from error
        files.append(file)
    return files


def _uncertain(
    points: Points,
) -> tuple[dict[str, Band], dict[str, tuple[pd.DataFrame, str]]]:
    """Bands of the levels over speed by group, and what tornado plots of them show."""
    own = [c for c in points.numbers if c not in {SPEED, TORQUE}]
    own = [c for c in own if (points.table[c].to_numpy(float) > 0.0).all()]
    bands, tornados = {}, {}
    table = points.table
    if TORQUE in points.numbers:
        table = table[table[TORQUE] == table[TORQUE].max()]
    for group in points.groups if own else ():
        level = f"{group}.rms"
        if SPEED not in points.numbers:
            tornados[group] = sensitivities(table, level, own), level
            continue
        found = sensitivities(table, level, own, SPEED)
        middle = table
        for name in own:
            middle = middle[middle[name] == base_value(table[name])]
        middle = middle.sort_values(SPEED)
        if not len(found) or not middle[level].notna().any():
            continue
        speed, values = middle[SPEED].to_numpy(float), middle[level].to_numpy(float)
        bands[group] = band(speed, values, found, SPEED)
        at = float(speed[np.nanargmax(values)])
        tornados[group] = found[found[SPEED] == at], f"{level} at {at:g} r/min"
    return bands, tornados

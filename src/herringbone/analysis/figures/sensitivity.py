"""Sensitivities of a level to parameters, from the points of a study.

    s = d ln(level) / d ln(parameter)

by a straight line through the logarithms of the points in which all other parameters have their
base value (the middle one of those that occur). The spread of a parameter is that of the study:
its largest and smallest values are the base times (1 + spread) and over it, if the base is their
geometric mean.
"""

import math
from collections.abc import Sequence

import numpy as np
import pandas as pd

from herringbone.core import ParameterError

SENSITIVITY = ".sensitivity."
"""Between group and parameter, in the name of a column of a study that was asked for them."""
_FEWEST = 2


def sensitivities(
    table: pd.DataFrame, figure: str, parameters: Sequence[str], along: str | None = None
) -> pd.DataFrame:
    """Sensitivities of a figure at each value of a parameter along which it is shown.

    Args:
        table: a row per point, one column per parameter and figure.
        figure: column of a positive figure, such as "seat_velocity.rms".
        parameters: columns of positive numbers.
        along: such as "speed"; one row per parameter and value of it. None: one per parameter.

    Returns:
        Columns "parameter", "sensitivity", "spread" [1], "points", and the one that is `along`.
        Where fewer than two points have a figure there is no row.

    Raises:
        ParameterError: a column is missing, or a parameter is not positive.
    """
    if missing := [c for c in (figure, *parameters, *([along] if along else ())) if c not in table]:
        raise ParameterError(f"sensitivities: the table has no column '{missing[0]}'")
    for name in parameters:
        if not (table[name].to_numpy(float) > 0.0).all():
            raise ParameterError(
                f"sensitivities: {name} has values that are not positive, which have no logarithm"
            )
    base = {name: base_value(table[name]) for name in parameters}
    columns = ["parameter", "sensitivity", "spread", "points", *([along] if along else ())]
    rows = []
    places = sorted(table[along].unique()) if along else [None]
    for place in places:
        here = table if place is None else table[table[along] == place]
        for name in parameters:
            others = [n for n in parameters if n != name]
            fixed = np.ones(len(here), dtype=bool)
            for other in others:
                fixed &= here[other].to_numpy(float) == base[other]
            alone = here[fixed]
            found = _slope(alone[name].to_numpy(float), alone[figure].to_numpy(float))
            if found is not None:
                rows.append((name, *found, *([place] if along else ())))
    return pd.DataFrame(rows, columns=columns)


def given_sensitivities(
    table: pd.DataFrame, group: str, spread: float, along: str | None = None
) -> pd.DataFrame:
    """Sensitivities of the level of a group that stand in the table of a study themselves.

    Args:
        table: a row per point, with columns `GROUP.sensitivity.PARAMETER`.
        group: of channels.
        spread: by which each of the parameters may err [1].
        along: see `sensitivities`.

    Returns:
        As `sensitivities`, without "points"; of points that have none there is no row.
    """
    start = f"{group}{SENSITIVITY}"
    rows = [
        (column.removeprefix(start), value, spread, *([place] if along else ()))
        for column in table.columns
        if column.startswith(start)
        for place, value in zip(table[along] if along else table.index, table[column], strict=True)
        if math.isfinite(value)
    ]
    columns = ["parameter", "sensitivity", "spread", *([along] if along else ())]
    return pd.DataFrame(rows, columns=columns)


def base_value(values: pd.Series) -> float:
    """The middle one of the values that occur; the lower of two."""
    different = np.unique(values.to_numpy(float))
    return float(different[(different.size - 1) // 2])


def _slope(parameter: np.ndarray, level: np.ndarray) -> tuple[float, float, int] | None:
    """Sensitivity, spread and how many points they are from."""
    known = np.isfinite(level) & (level > 0.0)
    p, y = np.log(parameter[known]), np.log(level[known])
    if np.unique(p).size < _FEWEST:
        return None
    off = p - p.mean()
    spread = math.expm1(0.5 * float(np.ptp(p)))
    return float(off @ y / (off @ off)), spread, int(known.sum())

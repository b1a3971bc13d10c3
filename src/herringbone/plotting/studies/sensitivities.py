"""Sensitivities of a level: a tornado plot, and the band in which the level lies."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from herringbone.core import ParameterError
from herringbone.plotting.studies.levels import Band
from herringbone.plotting.style import COLOURS, new_figure, styled

PARAMETER, SENSITIVITY, SPREAD = "parameter", "sensitivity", "spread"
_MOST_BARS = 20
_WIDTH, _CHARACTER = 9.5, 0.075
"""Of the picture, and of a character of a name [inch]."""
_BAR = 0.28
"""Height of a bar [inch]."""


def _checked(sensitivities: pd.DataFrame, *more: str) -> None:
    needed = [PARAMETER, SENSITIVITY, SPREAD, *more]
    if missing := [c for c in needed if c not in sensitivities]:
        raise ParameterError(
            f"sensitivities: the table has no column '{missing[0]}'; it takes {', '.join(needed)}"
        )


def changes(sensitivities: pd.DataFrame) -> pd.DataFrame:
    """What each parameter's spread makes of a level, relative: columns "low" and "high".

    A level that goes with p^s is multiplied by (1 + spread)^s or divided by it.

    Args:
        sensitivities: "sensitivity" s = d ln(level) / d ln(parameter), "spread" of the parameter:
            it lies between p / (1 + spread) and p (1 + spread).

    Raises:
        ParameterError: a column is missing, or a spread is negative.
    """
    _checked(sensitivities)
    spread, s = (sensitivities[c].to_numpy(float) for c in (SPREAD, SENSITIVITY))
    if not (spread >= 0.0).all():
        raise ParameterError("sensitivities: a spread must not be negative")
    ends = np.sort([(1.0 + spread) ** -s - 1.0, (1.0 + spread) ** s - 1.0], axis=0)
    return sensitivities.assign(low=ends[0], high=ends[1])


@styled
def tornado(sensitivities: pd.DataFrame, title: str = "") -> Figure:
    """Change of a level by the spread of each parameter, the largest on top.

    Args:
        sensitivities: one row per parameter: "parameter", "sensitivity" (d ln level / d ln p),
            "spread" (0.5: known within a factor 1.5).
        title: of which level, where.

    Raises:
        ParameterError: see `changes`.
    """
    found = changes(sensitivities)
    found = found.assign(size=found["high"] - found["low"]).sort_values("size", ascending=False)
    hidden = len(found) - min(len(found), _MOST_BARS)
    more = f" ({hidden} smaller ones not shown)" if hidden else ""
    rows = found.head(_MOST_BARS).iloc[::-1]
    figure = new_figure(f"What parameters make of {title or 'the level'}{more}", 1, width=_WIDTH)
    figure.set_figheight(1.6 + _BAR * len(rows))
    told = [
        f"{name} (factor {1.0 + spread:.3g}, p^{s:.2f})"
        for name, spread, s in zip(rows[PARAMETER], rows[SPREAD], rows[SENSITIVITY], strict=True)
    ]
    margin = min(0.6, max(0.42, 0.02 + _CHARACTER * max(map(len, told)) / _WIDTH))
    figure.subplots_adjust(left=margin, bottom=0.55 / (1.6 + _BAR * len(rows)))
    axes = figure.subplots()
    places = np.arange(len(rows))
    left = 100.0 * rows["low"].to_numpy()
    axes.barh(
        places, 100.0 * rows["high"].to_numpy() - left, left=left, color=COLOURS[0], height=0.7
    )
    axes.axvline(0.0, color="black", linewidth=0.8)
    axes.margins(x=0.08)
    axes.use_sticky_edges = False
    axes.set_yticks(places, told)
    axes.grid(visible=False, axis="y")
    axes.set_xlabel("change of the level [%]")
    return figure


def band(across: np.ndarray, level: np.ndarray, sensitivities: pd.DataFrame, of: str) -> Band:
    """Levels between which a curve lies if parameters err independently of each other.

    Logarithmic changes add up by their squares: factor exp(-+ sqrt(sum (s ln(1 + spread))^2)).

    Args:
        across: (n,) abscissa.
        level: (n,) SI unit.
        sensitivities: rows of "parameter", "sensitivity", "spread" at each place, column `of`.
        of: the column that holds the place of a row, such as "speed".

    Raises:
        ParameterError: a column is missing.
    """
    _checked(sensitivities, of)
    log = sensitivities[SENSITIVITY] * np.log1p(sensitivities[SPREAD])
    squares = (log**2).groupby(sensitivities[of]).sum()
    spread = np.sqrt(np.array([squares.get(x, np.nan) for x in across]))
    known = np.isfinite(spread) & np.isfinite(level)
    at, height, width = across[known], level[known], spread[known]
    names = sensitivities[PARAMETER].nunique()
    return Band(at, height * np.exp(-width), height * np.exp(width), f"{names} parameters err")

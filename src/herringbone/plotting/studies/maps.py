"""A figure of a study over two parameters, such as speed and torque."""

import numpy as np
from matplotlib.figure import Figure

from herringbone.analysis.set_points import SPEED, TORQUE
from herringbone.core import ParameterError
from herringbone.plotting.studies.table import Points
from herringbone.plotting.style import new_figure, styled

_FEWEST = 3
"""Values of a parameter that make rows of a map; of fewer, the curves of the levels tell more."""


@styled
def level_map(
    points: Points, figures: tuple[str, ...] = (), across: str | None = None, up: str | None = None
) -> Figure:
    """Figures as colours over two parameters; cells without a point stay white.

    Args:
        points: of a study over two numbers at least; of several points in a cell, which differ in
            further parameters, the largest figure is shown, and the title says so.
        figures: columns; the rms of all groups if none are given.
        across, up: parameters; speed and torque, or the first two numbers, if not given.

    Raises:
        ParameterError: the points do not vary two numbers, or there is no such column.
    """
    across = points.across(across)
    up = up or next(
        (c for c in (TORQUE, *points.numbers) if c in points.numbers and c != across), ""
    )
    if up not in points.numbers or up == across:
        raise ParameterError(
            f"a map takes two parameters that are varied; there are: {', '.join(points.numbers)}"
        )
    columns = figures or tuple(f"{group}.rms" for group in points.groups)
    if wrong := [c for c in columns if c not in points.table]:
        raise ParameterError(f"the table has no column '{wrong[0]}'")
    if not columns:
        raise ParameterError("the table has no levels: there is no column that ends in .rms")
    cells = points.table.groupby([up, across], dropna=False)
    most = points.told_largest(up, across)
    title = points.headline(f"Levels over {across} and {up}{most}{points.told_lost}")
    figure = new_figure(title, 1, len(columns), width=7.0 * len(columns), gap=1.2)
    figure.set_figheight(5.5)
    panels = figure.subplots(1, len(columns), squeeze=False)[0]
    for axes, column in zip(panels, columns, strict=True):
        factor, unit = points.scale(column)
        grid = cells[column].max().unstack(across).sort_index()
        drawn = axes.pcolormesh(
            grid.columns.to_numpy(float) * points.scale(across)[0],
            grid.index.to_numpy(float) * points.scale(up)[0],
            factor * np.ma.masked_invalid(grid.to_numpy(float)), shading="nearest", cmap="viridis",
        )  # fmt: skip
        axes.grid(visible=False)
        figure.colorbar(drawn, ax=axes, pad=0.02).set_label(f"{column} [{unit}]")
        axes.set_xlabel(points.scaled_label(across))
        axes.set_ylabel(points.scaled_label(up))
        axes.set_title(column, fontsize=8.5)
    return figure


def is_map(points: Points) -> bool:
    """True if two numbers make a map: speed, torque, or one with three values at least."""
    able = [
        name
        for name in points.numbers
        if name in {SPEED, TORQUE} or points.table[name].nunique() >= _FEWEST
    ]
    return len(able) >= 2

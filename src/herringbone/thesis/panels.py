"""Panels of signals in the layout of figures 3.5 to 3.20 and 4.9 to 4.16."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import pandas as pd

from herringbone.thesis.ground import unit as unit_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MS = 1e3


def signal_panels(
    title: str, pictured: Mapping[str, pd.DataFrame], signals: Sequence[str], units: Sequence[str]
) -> "Figure":
    """Signals over time, two panels a row; one curve for each table, the mean of each taken out.

    Args:
        title: of the figure.
        pictured: tables with a column `time` [s], by what the legend calls them.
        signals: columns, in the order of the panels.
        units: of these.
    """
    from herringbone.plotting.style import figure_legend, new_figure  # noqa: PLC0415 (lazy)

    figure = new_figure(title, (len(signals) + 1) // 2, 2, width=12.5)
    panels: list[Axes] = list(figure.subplots((len(signals) + 1) // 2, 2, sharex=True).flat)
    for axes, signal, unit in zip(panels, signals, units, strict=True):
        for name, rows in pictured.items():
            values = rows[signal]
            axes.plot(_MS * rows["time"], values - values.mean(), label=name, linewidth=0.9)
        axes.set_title(signal)
        axes.set_ylabel(unit)
        axes.margins(x=0.0)
    for axes in panels[-2:]:
        axes.set_xlabel("time [ms]")
    figure_legend(figure, panels[0])
    return figure


def level_panels(
    title: str,
    levels: pd.DataFrame,
    over: str,
    signals: Sequence[str],
    label: str,
    split: str = "",
) -> "Figure":
    """Levels over a parameter, two panels a row; one curve for each value of another column.

    Args:
        title: of the figure.
        levels: a row per point.
        over: column of the abscissa.
        signals: columns, in the order of the panels.
        label: of the abscissa.
        split: column whose values make curves; one curve if "".
    """
    from herringbone.plotting.style import figure_legend, new_figure  # noqa: PLC0415 (lazy)

    figure = new_figure(title, (len(signals) + 1) // 2, 2, width=12.5)
    panels: list[Axes] = list(figure.subplots((len(signals) + 1) // 2, 2, sharex=True).flat)
    groups = levels.groupby(split, sort=False) if split else [("", levels)]
    for name, rows in groups:
        for axes, signal in zip(panels, signals, strict=True):
            axes.plot(rows[over], rows[signal], marker="o", markersize=4.0, label=str(name))
    for axes, signal in zip(panels, signals, strict=True):
        axes.set_title(signal)
        axes.set_ylabel(f"rms [{unit_of(signal)}]")
        axes.set_ylim(bottom=0.0)
    for axes in panels[-2:]:
        axes.set_xlabel(label)
    if split:
        figure_legend(figure, panels[0])
    return figure

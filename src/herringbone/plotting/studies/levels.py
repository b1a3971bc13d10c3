"""Levels and order cuts over a parameter of a study, with its resonances."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.signal import find_peaks

from herringbone.analysis.set_points import SPEED
from herringbone.plotting.studies.coinciding import coinciding
from herringbone.plotting.studies.table import Points, checked_groups, thinned
from herringbone.plotting.style import COLOURS, MARKER_COLOUR, legend, new_figure, styled

_PROMINENCE = 1.15
"""Ratio of a peak's level to the higher one of the valleys beside it, from which it is marked."""
_MOST_MARKS = 12
_ORDERS = 6
_OF_MARKS = 2
"""Points of a line that is a mark and no curve, at most."""
_WORDS = 2
"""Of an output's name that are shown, at least."""
_ENTRY, _CHARACTER = 0.2, 0.062
"""Height of an entry of the legend, and width of a character in it [inch]."""


class Band:
    """Levels between which a figure may lie, see `levels`.

    Args:
        across: (n,) values of the abscissa, ascending.
        low, high: (n,) of the figure, its SI unit.
        label: what it stands for.
    """

    def __init__(self, across: np.ndarray, low: np.ndarray, high: np.ndarray, label: str) -> None:
        self.across, self.low, self.high, self.label = across, low, high, label


@styled
def levels(
    points: Points,
    across: str | None = None,
    groups: Sequence[str] = (),
    bands: dict[str, Band] | None = None,
    resonances: pd.DataFrame | None = None,
) -> Figure:
    """Level (rms) of each group, and its mesh orders, over a parameter; one row per group.

    Left: the rms, one curve per combination of the other parameters. Right: rms and mesh orders of
    the last combination. Peaks of the rms are marked with their place, and resonances that are
    given by triangles in the colour of their order. Points without figures are gaps, and told in
    the title.

    Args:
        points: of a study.
        across: parameter of the abscissa; speed, or the first number, if not given.
        groups: that are shown; all if none are given.
        bands: by group, shaded around the curves.
        resonances: "speed" [r/min] and "order", see `NaturalModes.crossings`; those worth showing.

    Raises:
        ParameterError: the table has no such parameter or group, or no levels.
    """
    across = points.across(across)
    shown = checked_groups(points, groups)
    curves = points.curves(across)
    kept = thinned(curves)
    hidden = f"; {len(kept)} of {len(curves)} curves" if len(kept) < len(curves) else ""
    title = points.headline(f"Levels{hidden}{points.told_lost}")
    figure = new_figure(title, len(shown), 2, width=14.5)
    panels = figure.subplots(len(shown), 2, squeeze=False, sharex=True)
    for (left, right), group in zip(panels, shown, strict=True):
        _rms(left, points, group, across, kept)
        if bands and group in bands:
            _shade(left, points, group, bands[group])
        _orders(right, points, group, across, *kept[-1])
        if resonances is not None and across == SPEED:
            _triangles(right, resonances)
        for axes in (left, right):
            axes.set_xlabel(points.label(across))
            _logarithmic(axes)
    _legend_below(figure, panels[0][0])
    return figure


def _legend_below(figure: Figure, axes: Axes) -> None:
    """One legend of the curves below all panels, which make room for it."""
    handles, labels = axes.get_legend_handles_labels()
    if not labels:
        return
    width, height = figure.get_size_inches()
    columns = max(1, min(4, int(width / (0.6 + _CHARACTER * max(map(len, labels))))))
    room = 0.15 + _ENTRY * -(-len(labels) // columns)
    pars = figure.subplotpars
    bottom, top = pars.bottom * height + room, (1.0 - pars.top) * height
    figure.set_figheight(height + room)
    figure.subplots_adjust(bottom=bottom / (height + room), top=1.0 - top / (height + room))
    figure.legend(handles, labels, loc="lower left", bbox_to_anchor=(0.05, 0.0), ncols=columns)


def _rms(
    axes: Axes,
    points: Points,
    group: str,
    across: str,
    curves: Sequence[tuple[str, pd.DataFrame]],
) -> None:
    column = f"{group}.rms"
    factor, unit = points.scale(column)
    drawn = []
    for i, (label, rows) in enumerate(curves):
        x, y = rows[across].to_numpy(float), factor * rows[column].to_numpy(float)
        drawn.append((x, y))
        line = "-" if i < len(COLOURS) else "--"
        axes.plot(x, y, marker="o", markersize=2.2, linestyle=line, label=label or None)
    told = coinciding([label for label, _ in curves], drawn)
    axes.set_title("\n".join(told), fontsize=7.5)
    _, rows = curves[-1]
    mark_peaks(axes, rows[across].to_numpy(float), factor * rows[column].to_numpy(float))
    axes.set_ylabel(f"{_label(points, group)}, rms [{unit}]")


def _label(points: Points, group: str) -> str:
    """What is drawn; of an output's name the end that tells it from others: panels are small."""
    words = points.called(group).split(".")
    every = [other.split(".") for other in points.groups]
    alone = (n for n in range(_WORDS, len(words)) if sum(o[-n:] == words[-n:] for o in every) == 1)
    return ".".join(words[-next(alone, len(words)) :])


def _orders(
    axes: Axes, points: Points, group: str, across: str, label: str, rows: pd.DataFrame
) -> None:
    """Mesh orders and rms of one curve."""
    column = f"{group}.rms"
    factor, unit = points.scale(column)
    x = rows[across].to_numpy(float)
    axes.plot(x, factor * rows[column], color="black", linewidth=1.6, label="rms")
    for order in points.orders(group)[:_ORDERS]:
        text = "$f_m$" if order == 1 else f"${order} f_m$"
        colour = COLOURS[(order - 1) % len(COLOURS)]
        axes.plot(x, factor * rows[f"{group}.order_{order}"], label=text, color=colour)
    axes.set_ylabel(f"{_label(points, group)}, amplitude [{unit}]")
    if label:
        axes.set_title(label, fontsize=8.5, pad=18.0)
    legend(axes, 7)


def _triangles(axes: Axes, resonances: pd.DataFrame) -> None:
    left, right = axes.get_xlim()
    for row in resonances.itertuples():
        if left <= row.speed <= right and 1 <= row.order <= _ORDERS:
            axes.plot([row.speed], [0.015], marker="^", markersize=5.0, linestyle="", clip_on=False,
                      color=COLOURS[int(row.order) - 1],
                      transform=axes.get_xaxis_transform())  # fmt: skip
    axes.set_xlim(left, right)


def _shade(axes: Axes, points: Points, group: str, band: Band) -> None:
    factor, _ = points.scale(f"{group}.rms")
    axes.fill_between(band.across, factor * band.low, factor * band.high, color=MARKER_COLOUR,
                      alpha=0.25, linewidth=0.0, label=band.label)  # fmt: skip


def _logarithmic(axes: Axes) -> None:
    """A logarithmic ordinate over three decades, if anything is positive."""
    every = [np.asarray(line.get_ydata(), float) for line in axes.lines]
    drawn = [y for y in every if y.size > _OF_MARKS]
    values = np.concatenate([*drawn, np.empty(0)])
    positive = values[np.isfinite(values) & (values > 0.0)]
    if positive.size:
        axes.set_yscale("log")
        axes.set_ylim(max(positive.min() * 0.7, positive.max() * 1e-3), positive.max() * 1.8)


def peaks(across: np.ndarray, level: np.ndarray) -> np.ndarray:
    """Places (n,) of the peaks of a level, the highest first.

    Args:
        across: (k,) ascending.
        level: (k,) positive; NaN where there is none.
    """
    known = np.isfinite(level) & (level > 0.0)
    found, _ = find_peaks(np.log(level[known]), prominence=np.log(_PROMINENCE))
    found = found[np.argsort(-level[known][found], kind="stable")]
    return across[known][found]


def mark_peaks(axes: Axes, across: np.ndarray, level: np.ndarray) -> None:
    """Mark the highest peaks with their places."""
    for at in peaks(across, level)[:_MOST_MARKS]:
        height = float(level[across == at][0])
        axes.axvline(at, color=MARKER_COLOUR, linewidth=0.7, linestyle=":", zorder=0.5)
        axes.text(at, height, f"{at:.4g}", fontsize=7.0, ha="center", va="bottom",
                  color=MARKER_COLOUR)  # fmt: skip

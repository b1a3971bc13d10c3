"""Picture of a comparison: both runs over each other."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from herringbone.analysis.accuracy.common_ground import Sides
from herringbone.analysis.accuracy.comparison import Comparison
from herringbone.analysis.figures.operating_point import run_mesh_frequency
from herringbone.analysis.figures.spectra import FEWEST_SAMPLES, PADDING, amplitude_spectrum
from herringbone.core.frequencies import HIGHEST, check_end
from herringbone.core.wording import percent
from herringbone.plotting.panels import DECADES, close_up, mark_orders
from herringbone.plotting.style import (
    COLOURS,
    draw_line,
    figure_legend,
    new_figure,
    scaled_unit,
    styled,
)
from herringbone.result.result import TIME, Result

_STYLES = ({"color": COLOURS[0], "linewidth": 2.2}, {"color": COLOURS[4], "linewidth": 1.0})
"""The second run is drawn narrow over the first, so that both are seen where they coincide."""


@styled
def comparison(found: Comparison, highest: float = HIGHEST) -> Figure:
    """The worst channel of each group: last mesh periods of the common times, and spectra.

    Args:
        found: two runs.
        highest: end of the spectra [Hz].

    Raises:
        ParameterError: the end is not positive.
    """
    check_end("highest", highest, finite=False)
    rows = list(found.groups.itertuples())
    title = f"{found.first.name} and {found.second.name}, worst channels"
    figure = new_figure(title, max(len(rows), 1), 2, width=14.5)
    panels = figure.subplots(max(len(rows), 1), 2, squeeze=False)
    for (left, right), row in zip(panels, rows, strict=False):
        column, unit = str(row.worst), found.second.result.units[str(row.worst)]
        peak = max(
            float(np.ptp(side.result.data[column].to_numpy()))
            for side in (found.first, found.second)
        )
        factor, shown = scaled_unit(unit, peak)
        for side, style in zip((found.first, found.second), _STYLES, strict=True):
            how = {"label": side.name, **style}
            _over_time(left, side.result, column, (factor, shown), found.end, how)
            _spectrum(right, side, column, factor, highest, how)
        off = f"{percent(float(row.worst_difference), 3)} apart"
        left.set_title(f"{row.group}: {column}, {off}", fontsize=8.5)
        _finish(right, found.second, shown, highest)
    figure_legend(figure, panels[0][0])
    return figure


def _over_time(
    axes: Axes, result: Result, column: str, scale: tuple[float, str], end: float, how: dict
) -> None:
    time = result.data[TIME].to_numpy()
    rows = close_up(result)
    length = time[rows][-1] - time[rows][0]
    shown = (time >= end - length) & (time <= end)
    values = result.data[column].to_numpy(float) * scale[0]
    draw_line(axes, 1e3 * time[shown], values[shown], **how)
    axes.set_xlabel("time [ms]")
    axes.set_ylabel(f"value [{scale[1]}]")
    axes.margins(x=0.0)


def _spectrum(
    axes: Axes, side: Sides, column: str, factor: float, highest: float, how: dict
) -> None:
    part = side.part
    if part.rows.stop - part.rows.start < FEWEST_SAMPLES:
        return
    values = side.result.data[column].to_numpy(float)[part.rows] * factor
    found = amplitude_spectrum(values, part.sample_step, padding=PADDING)
    shown = found.frequency <= highest
    floor = float(found.amplitude.max()) * 10.0 ** -(DECADES + 1.0)
    draw_line(axes, found.frequency[shown], np.maximum(found.amplitude[shown], floor), **how)


def _finish(axes: Axes, side: Sides, unit: str, highest: float) -> None:
    axes.set_ylabel(f"amplitude [{unit}]")
    step = side.part.sample_step
    recorded = 0.5 / step if step else highest
    cut = f", cut at {highest:.0f} of {recorded:.0f} Hz" if highest < recorded else ""
    axes.set_xlabel(f"frequency{cut} [Hz]")
    if not axes.lines:
        axes.text(0.5, 0.5, "no spectrum: too few records", ha="center", transform=axes.transAxes)
        return
    axes.set_xlim(0.0, min(highest, recorded))
    top = max(float(np.max(line.get_ydata())) for line in axes.lines)
    if top > 0.0:
        axes.set_yscale("log")
        axes.set_ylim(top * 10.0**-DECADES, 1.6 * top)
    mark_orders(axes, run_mesh_frequency(side.result, part=side.part), min(highest, recorded))

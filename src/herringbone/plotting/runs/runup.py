"""Pictures of run-ups: waterfall over speed and frequency, and mesh orders over speed."""

import math
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from herringbone.analysis.asked import group
from herringbone.analysis.figures.order_tracking import OrderMap
from herringbone.analysis.figures.runup import (
    BLOCK,
    HIGHEST,
    rotation,
    speed_changes,
    tracked,
    waterfall,
)
from herringbone.core import ParameterError
from herringbone.core.declaring.units import R_MIN
from herringbone.core.frequencies import check_end
from herringbone.plotting.maps import decibels_map, order_rays
from herringbone.plotting.panels import headline
from herringbone.plotting.style import legend, new_figure, scaled_unit, styled
from herringbone.result.result import Result

_CHANNELS = "bearing_force", "seat_velocity"


@styled
def run_up(
    result: Result,
    *patterns: str,
    highest: float | None = None,
    order: float = HIGHEST,
    block: float = BLOCK,
) -> Figure:
    """Waterfall and mesh orders of columns over the pinion's speed, one row per column.

    Args:
        result: of a run whose speed changes.
        patterns: columns (`*`, `?`); if none are given, of bearing forces and seat velocities those
            with the largest level.
        highest: frequency up to which the waterfall goes [Hz]; the highest order's if not given.
        order: highest mesh order that is tracked.
        block: mesh periods in a block of order tracking.

    Raises:
        ParameterError: the speed does not change, an end is not positive, or see
            `analysis.figures.runup`.
    """
    if highest is not None:
        check_end("highest", highest, finite=False)
    check_end("order", order, "")
    result = result.uniform()
    if not speed_changes(result):
        raise ParameterError(f"system '{result.info.system}' records no change of speed")
    maps = _tracked(result, patterns, block, order)
    teeth = rotation(result).teeth
    figure = new_figure(headline(result, "Orders over speed"), len(maps), 2, width=14.5)
    panels = figure.subplots(len(maps), 2, squeeze=False)
    for (left, right), (column, found) in zip(panels, maps.items(), strict=True):
        _waterfall(left, result, column, found, highest, teeth)
        _cuts(right, result, column, found, teeth)
    for left, right in panels[:-1]:
        left.set_xlabel("")
        right.set_xlabel("")
    return figure


def _tracked(
    result: Result, patterns: Sequence[str], block: float, order: float
) -> Mapping[str, OrderMap]:
    """Order maps by column."""
    if patterns:
        columns = result.columns(*patterns)
        return {c: tracked(result, c, block=block, highest=order) for c in columns}
    chosen: dict[str, OrderMap] = {}
    for name in _CHANNELS:
        maps = {c: tracked(result, c, block=block, highest=order) for c in group(result, name)}
        if maps:
            largest = max(maps, key=lambda c: float(np.median(maps[c].level)))
            chosen[largest] = maps[largest]
    if not chosen:
        raise ParameterError(
            f"system '{result.info.system}' records no bearing forces or seat velocities; name the "
            "columns"
        )
    return chosen


def _waterfall(
    axes: Axes, result: Result, column: str, found: OrderMap, highest: float | None, teeth: float
) -> None:
    spectra = waterfall(result, column)
    nyquist = float(spectra.frequency[-1])
    wanted = float(found.order[-1] * found.speed.max()) if highest is None else highest
    shown = spectra.frequency <= min(wanted, nyquist)
    factor, unit = scaled_unit(result.units[column], float(spectra.amplitude.max()))
    speed = spectra.speed * R_MIN
    ordered = np.argsort(speed, kind="stable")
    decibels_map(
        axes,
        speed[ordered],
        spectra.frequency[shown],
        factor * spectra.amplitude[ordered][:, shown],
        unit,
    )
    order_rays(axes, teeth, math.floor(found.order[-1]))
    axes.set_xlabel("pinion speed [r/min]")
    axes.set_ylabel(f"frequency, cut at {spectra.frequency[shown][-1]:.0f} of {nyquist:.0f} [Hz]")
    axes.set_title(column, fontsize=8.5)


def _cuts(axes: Axes, result: Result, column: str, found: OrderMap, teeth: float) -> None:
    """Amplitudes of the mesh orders and the rms level of all."""
    factor, unit = scaled_unit(result.units[column], float(np.nanmax(found.amplitude)))
    speed = 60.0 * found.speed / teeth
    axes.plot(speed, factor * found.level, color="black", linewidth=1.6, label="rms of all")
    for order in range(1, math.floor(found.order[-1]) + 1):
        text = "$f_m$" if order == 1 else f"${order} f_m$"
        axes.plot(speed, factor * found.cut(order), label=text)
    axes.set_xlabel("pinion speed [r/min]")
    axes.set_ylabel(f"amplitude of orders [{unit}]")
    axes.set_yscale("log")
    top = float(np.nanmax(factor * found.level))
    if top > 0.0:
        axes.set_ylim(top * 1e-3, 2.0 * top)
    legend(axes, 8)

"""Pictures of a run over frequency: amplitude spectra and radiated power."""

import numpy as np
from matplotlib.figure import Figure

from herringbone.analysis.asked import by_half
from herringbone.analysis.figures.operating_point import run_mesh_frequency, steady_part
from herringbone.analysis.figures.radiated_power import LABEL, level_db
from herringbone.analysis.figures.radiated_power import radiated_power as power_of
from herringbone.core import ParameterError
from herringbone.core.frequencies import HIGHEST, check_end
from herringbone.plotting.panels import (
    DECADES,
    MM,
    headline,
    mark_orders,
    mesh_columns,
    spectrum_panel,
)
from herringbone.plotting.style import MARKER_COLOUR, draw_line, figure_legend, new_figure, styled
from herringbone.result.result import Result


@styled
def spectra(result: Result, highest: float = HIGHEST) -> Figure:
    """Amplitude spectra of bearing forces [N] and seat velocities [mm/s].

    Mesh orders are marked when the speed is steady.

    Args:
        result: of a run.
        highest: end of the spectra [Hz].

    Raises:
        ParameterError: the system records neither, or the end is not positive.
    """
    check_end("highest", highest, finite=False)
    result = result.uniform()
    shown = []
    for channel, axes, what, factor, unit in (
        ("bearing_force", "yz", "bearing force", 1.0, "N"),
        ("seat_velocity", "xyz", "seat velocity", MM, "mm/s"),
    ):
        found = [(axis, by_half(result, channel, axis)) for axis in axes]
        row = [(f"{what} {axis}", columns, factor, unit) for axis, columns in found if columns]
        shown += [row] if row else []
    if not shown:
        raise ParameterError(f"system '{result.info.system}' records no bearing forces")
    if len(shown[0]) == 2 and (mesh := mesh_columns(result)):
        shown[0].append(("mesh force", mesh, 1.0, "N"))
    part, frequency = steady_part(result), run_mesh_frequency(result)
    what = f"Amplitude spectra, {part.begin:.3g} to {part.end:.3g} s"
    what += f", $f_m$ = {frequency:.1f} Hz" if frequency else ""
    width = max(map(len, shown))
    figure = new_figure(headline(result, what), len(shown), width, width=14.5)
    panels = figure.subplots(len(shown), width, squeeze=False)
    for axes_row, row in zip(panels, shown, strict=True):
        for axes in axes_row[len(row) :]:
            axes.set_visible(False)
        for axes, (label, columns, factor, unit) in zip(axes_row, row, strict=False):
            spectrum_panel(axes, result, columns, label, factor=factor, unit=unit, highest=highest)
    figure_legend(figure, *panels.flat)
    return figure


@styled
def radiated_power(result: Result) -> Figure:
    """Equivalent radiated power of the housing in bins, dB re 1 pW, with the mesh orders.

    Raises:
        ParameterError: nothing moves; or see `analysis.figures.radiated_power`.
    """
    found = power_of(result)
    if not found.total:
        raise ParameterError("nothing moves: no radiated power")
    what = f"Radiated power, {found.level_db:.1f} dB re 1 pW in all"
    figure = new_figure(headline(result, what), 1)
    axes = figure.subplots()
    level = level_db(found.power)
    top = float(level.max())
    bottom = top - 20.0 * DECADES
    draw_line(axes, found.frequency_hz, np.maximum(level, bottom - 10.0))
    axes.set_ylim(bottom, top + 5.0)
    axes.set_xlim(0.0, float(found.frequency_hz[-1]))
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel(f"power in {found.resolution_hz:.3g} Hz [dB re 1 pW]")
    mark_orders(axes, run_mesh_frequency(result), float(found.frequency_hz[-1]))
    figure.text(0.99, 0.01, LABEL, ha="right", va="bottom", fontsize=8, color=MARKER_COLOUR)
    return figure

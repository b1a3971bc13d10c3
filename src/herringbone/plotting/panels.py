"""Panels of the pictures: signals over time, and spectra with mesh orders."""

import math
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import SymmetricalLogLocator
from matplotlib.transforms import blended_transform_factory

from herringbone.analysis.asked import mesh_forces
from herringbone.analysis.figures.folds import folds, turns_of
from herringbone.analysis.figures.operating_point import run_mesh_frequency, steady_part
from herringbone.analysis.figures.spectra import (
    FEWEST_SAMPLES,
    PADDING,
    amplitude_spectrum,
    mesh_orders,
)
from herringbone.core.frequencies import HIGHEST
from herringbone.plotting.folds import mark_folds
from herringbone.plotting.style import COLOURS, HALF_STYLE, MARKER_COLOUR, depths, draw_line
from herringbone.result.result import TIME, Result

SHOWN_PERIODS = 6
"""Mesh periods that a close-up shows."""
MM = 1e3
"""Of SI lengths and velocities, as they are shown."""
DECADES = 3.5
"""Range of amplitudes in a spectrum."""
_CLOSE_UP_SHARE, _CLOSE_UP_ROWS = 0.05, 100
_MOST_MARKS = 9
_FEW_BINS = 60
"""A spectrum of fewer independent frequencies shows them as points."""
_LARGE = 1e6
_WIDE = 2.2
_SAME = 0.01
"""Difference of spectra, over their largest line, that cannot be seen."""


def headline(result: Result, what: str) -> str:
    """Title of a picture: what it shows, of which run."""
    info = result.info
    scene = f", scene {info.scene}" if info.scene else ""
    return f"{what}: {info.system}{scene}"


def half_name(half: str) -> str:
    """`pinion_left` -> `pinion left`; other names stay, and are shown as they are.

    matplotlib leaves entries out that begin with an underscore, and sets what stands between dollar
    signs as a formula.
    """
    if half in HALF_STYLE:
        return half.replace("_", " ")
    name = half.replace("$", r"\$")
    return f" {name}" if name.startswith("_") else name


def mesh_columns(result: Result) -> dict[str, str]:
    """Columns of the normal forces of the meshes, by the names that `HALF_STYLE` knows."""
    return {f"mesh_{side}": column for side, column in mesh_forces(result).items()}


def close_up(result: Result) -> slice:
    """Rows of the last few mesh periods; if no mesh is seen, of the last 5 %, at least 100 rows."""
    time = result.data[TIME].to_numpy()
    if time.size < 2:
        return slice(0, time.size)
    frequency = run_mesh_frequency(result)
    span = float(time[-1] - time[0])
    length = SHOWN_PERIODS / frequency if frequency else _CLOSE_UP_SHARE * span
    first = int(np.searchsorted(time, time[0] + span - min(length, span)))
    if not frequency:
        first = min(first, max(0, time.size - _CLOSE_UP_ROWS))
    return slice(first, time.size)


def time_panel(
    axes: Axes,
    result: Result,
    columns: Mapping[str, str],
    label: str,
    *,
    factor: float = 1.0,
    unit: str = "",
    rows: slice | None = None,
    mean: bool = False,
) -> None:
    """Signals over time; a part of the run is shown in ms.

    Args:
        axes: to draw in.
        result: of a run.
        columns: column by legend entry or gear half.
        label: of the ordinate, without unit.
        factor: multiplies the SI value.
        unit: of the ordinate.
        rows: part of the table that is shown, all if not given.
        mean: show the signal without its mean over the steady part, and the mean in the legend.
    """
    diverged = result.outcome.unstable
    axes.set_ylabel(f"{label}{', AC' if mean and not diverged else ''} [{unit}]")
    axes.set_xlabel("time [s]" if rows is None else "time [ms]")
    if result.data.empty:
        return
    shown, data = (slice(None), result.over_time) if rows is None else (rows, result.data)
    time = data[TIME].to_numpy()[shown] * (1.0 if rows is None else 1e3)
    values = data[list(columns.values())].to_numpy() * factor
    entries = [half_name(name) for name in columns]
    if mean and not diverged:
        part = steady_part(result)
        values, entries = _without_mean(values, part.rows if part.steady else shown, entries, unit)
    depth = depths(values[shown])
    for i, name in enumerate(columns):
        style = HALF_STYLE.get(name, {"linestyle": "--" if i >= len(COLOURS) else "-"})
        draw_line(axes, time, values[shown, i], label=entries[i], zorder=depth[i], **style)
    axes.margins(x=0.0)
    if diverged:
        _show_all_decades(axes, values[shown])


def _without_mean(
    values: np.ndarray, steady: slice, entries: Sequence[str], unit: str
) -> tuple[np.ndarray, list[str]]:
    """Signals (n, m) without their means over the steady rows, which their entries then tell."""
    average, spread = values[steady].mean(axis=0), np.ptp(values[steady], axis=0)
    told = [
        f"{entry}, mean {rounded(m, max(abs(m), s))} {unit}"
        for entry, m, s in zip(entries, average, spread, strict=True)
    ]
    return values - average, told


def _show_all_decades(axes: Axes, values: np.ndarray) -> None:
    """An ordinate on which a diverging signal still shows how it began."""
    typical = float(np.median(np.abs(values)))
    axes.set_yscale("symlog", linthresh=min(max(10.0 * typical, 1e-9), 1e20), linscale=2.0)
    axes.yaxis.set_major_locator(SymmetricalLogLocator(axes.yaxis.get_transform()))
    axes.locator_params(axis="y", numticks=7)


def rounded(value: float, scale: float) -> str:
    """A value with the decimals that make four digits of `scale`."""
    if scale >= _LARGE:
        return f"{value:.4g}"
    decimals = max(0, 3 - math.floor(math.log10(scale))) if 0.0 < scale < math.inf else 0
    text = f"{round(value, decimals) + 0.0:.{decimals}f}"
    return text.replace("-", "\N{MINUS SIGN}")


def spectrum_panel(
    axes: Axes,
    result: Result,
    columns: Mapping[str, str],
    label: str,
    *,
    factor: float = 1.0,
    unit: str = "",
    highest: float = HIGHEST,
) -> None:
    """Amplitude spectra of the steady part, with the mesh orders marked.

    The label of the abscissa tells the resolution, and where the spectrum is cut; if the resolution
    is coarse, points tell it, too: what lies between them is interpolated. Left halves are drawn
    wider than right ones, which would cover them; where both coincide, a line says so.

    Args:
        axes: to draw in.
        result: of a run.
        columns: column by legend entry or gear half.
        label: of the ordinate, without unit.
        factor: multiplies the SI value.
        unit: of the ordinate.
        highest: end of the spectra [Hz].
    """
    part = steady_part(result)
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel(f"{label} [{unit}]")
    diverged = result.outcome.unstable
    if diverged or part.rows.stop - part.rows.start < FEWEST_SAMPLES:
        why = "the run diverged" if diverged else "too few records"
        axes.text(0.5, 0.5, f"no spectrum: {why}", ha="center", transform=axes.transAxes)
        return
    signals = result.data[list(columns.values())].to_numpy()[part.rows] * factor
    spectrum = amplitude_spectrum(signals, part.sample_step, padding=PADDING)
    recorded = float(spectrum.frequency[-1])
    highest = min(highest, recorded)
    shown = spectrum.frequency <= highest
    frequency, amplitude = spectrum.frequency[shown], spectrum.amplitude[shown]
    cut = f", cut at {highest:.0f} of {recorded:.0f} Hz" if highest < recorded else ""
    axes.set_xlabel(f"frequency (resolution {spectrum.resolution:.3g} Hz{cut}) [Hz]")
    coarse = highest / spectrum.resolution < _FEW_BINS
    marks = {"marker": "o", "markersize": 3.0, "markevery": PADDING} if coarse else {}
    top = float(amplitude.max())
    for i, name in enumerate(columns):
        height = np.maximum(amplitude[:, i], top * 10.0 ** -(DECADES + 1.0))
        wide = {"linewidth": _WIDE} if name.endswith("_left") else {}
        style = {**HALF_STYLE.get(name, {}), **marks, **wide}
        draw_line(axes, frequency, height, label=half_name(name), **style)
    if same := _coinciding(list(columns), amplitude):
        axes.text(0.99, 0.97, f"left and right coincide: {', '.join(same)}", ha="right", va="top",
                  transform=axes.transAxes, fontsize=7.5, color=MARKER_COLOUR)  # fmt: skip
    if top > 0.0:
        axes.set_yscale("log")
        axes.set_ylim(top * 10.0**-DECADES, top * 1.6)
    axes.set_xlim(0.0, highest)
    if not part.steady:
        axes.text(1.0, 1.0, "speed not steady: no mesh orders", ha="right", va="bottom",
                  transform=axes.transAxes, fontsize=8, color=MARKER_COLOUR)  # fmt: skip
    mesh = run_mesh_frequency(result)
    mark_orders(axes, mesh, highest)
    if mesh:
        mark_folds(axes, folds(spectrum, mesh, highest, turns_of(result, mesh)), recorded)


def _coinciding(names: Sequence[str], amplitude: np.ndarray) -> list[str]:
    """Gears or meshes whose left and right spectra, columns of (k, m), differ by less than 1 %."""
    place = {name: i for i, name in enumerate(names)}
    found = []
    for name, i in place.items():
        other = place.get(f"{name.removesuffix('_left')}_right")
        if not name.endswith("_left") or other is None:
            continue
        left, right = amplitude[:, i], amplitude[:, other]
        if np.abs(left - right).max() <= _SAME * max(left.max(), right.max()):
            found.append(half_name(name).removesuffix(" left").removesuffix("_left"))
    return found


def mark_orders(axes: Axes, frequency: float | None, highest: float) -> None:
    """Mark the multiples of the mesh frequency [Hz], if it is known, up to `highest` [Hz]."""
    above = blended_transform_factory(axes.transData, axes.transAxes)
    orders = mesh_orders(frequency or 0.0, highest)
    every = max(1, -(-len(orders) // _MOST_MARKS))
    for order, at in orders[every - 1 :: every]:
        axes.axvline(at, color=MARKER_COLOUR, linewidth=0.8, linestyle=":", zorder=0.5)
        text = "$f_m$" if order == 1 else f"${order} f_m$"
        axes.text(at, 1.0, text, transform=above, ha="center", va="bottom", fontsize=8,
                  color=MARKER_COLOUR)  # fmt: skip

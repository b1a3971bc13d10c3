"""Picture of a system's sensors: what they sample, and its spectrum up to half the rate."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from herringbone.analysis.figures.operating_point import run_mesh_frequency
from herringbone.analysis.figures.sensing.sensors import SensorFigures, sensor_figures
from herringbone.analysis.figures.sensing.velocity_sensor import VelocitySensor
from herringbone.analysis.figures.spectra import (
    FEWEST_SAMPLES,
    PADDING,
    amplitude_spectrum,
    mesh_orders,
)
from herringbone.core import ParameterError
from herringbone.plotting.panels import DECADES, MM, headline
from herringbone.plotting.style import (
    COLOURS,
    MARKER_COLOUR,
    draw_line,
    figure_legend,
    new_figure,
    styled,
)
from herringbone.result.result import Result

_SHOWN_SAMPLES = 80
_MOST_MARKS = 8
_LIFT = 0.04
"""Of every second mark: neighbours do not cover each other."""


@styled
def sensors(result: Result) -> Figure:
    """Samples of the sensors [mm/s]: all of them, the last ones, and spectra.

    Mesh harmonics above half the sampling rate are marked where they show, folded.

    Raises:
        ParameterError: the system has no sensors, or none that the run answers.
    """
    found, refused = sensor_figures(result)
    if not found:
        why = "; ".join(dict.fromkeys(refused.values())) or "the system declares none"
        raise ParameterError(f"system '{result.info.system}' records no sensors: {why}")
    figure = new_figure(headline(result, "Sensors, as sampled"), 1, 3, width=14.5)
    whole, last, spectrum = figure.subplots(1, 3, width_ratios=(0.8, 0.8, 1.4))
    for i, (name, one) in enumerate(found.items()):
        label = f"{name} ({one.spec.axis})"
        how = {"color": COLOURS[i % len(COLOURS)], "label": label}
        values = MM * one.velocity
        draw_line(whole, one.time, values, **how)
        shown = slice(-_SHOWN_SAMPLES, None)
        last.plot(MM * one.time[shown], values[shown], marker=".", linewidth=0.8, **how)
        _spectrum(spectrum, one, how)
    for axes, unit in ((whole, "s"), (last, "ms")):
        axes.set_xlabel(f"time [{unit}]")
        axes.set_ylabel("velocity [mm/s]")
        axes.margins(x=0.0)
    last.set_title(f"last {_SHOWN_SAMPLES} samples")
    _finish(spectrum, result, [one.chain for one in found.values()])
    figure_legend(figure, last)
    return figure


def _spectrum(axes: Axes, one: SensorFigures, how: dict) -> None:
    samples = one.velocity[one.steady]
    if len(samples) < FEWEST_SAMPLES:
        return
    found = amplitude_spectrum(samples, 1.0 / one.chain.sampling_hz, padding=PADDING)
    top = float(found.amplitude.max())
    height = np.maximum(found.amplitude, top * 10.0 ** -(DECADES + 1.0))
    draw_line(axes, found.frequency, MM * height, **how)


def _finish(axes: Axes, result: Result, chains: list[VelocitySensor]) -> None:
    axes.set_xlabel("frequency as sampled [Hz]")
    axes.set_ylabel("amplitude [mm/s]")
    if not axes.lines:
        axes.text(0.5, 0.5, "no spectrum: too few samples", ha="center", transform=axes.transAxes)
        return
    half = 0.5 * max(chain.sampling_hz for chain in chains)
    axes.set_xlim(0.0, half)
    top = max(float(np.max(line.get_ydata())) for line in axes.lines)
    if top > 0.0:
        axes.set_yscale("log")
        axes.set_ylim(top * 10.0**-DECADES, 1.6 * top)
    if len({chain.sampling_hz for chain in chains}) > 1:  # each folds its own way
        return
    places: dict[float, list[str]] = {}
    for order, frequency in mesh_orders(run_mesh_frequency(result) or 0.0, 20.0 * half):
        if order > _MOST_MARKS:
            break
        at = round(chains[0].alias_hz(frequency), 3)
        text = "$f_m$" if order == 1 else f"${order} f_m$"
        places.setdefault(at, []).append(text if frequency <= half else f"({text})")
    axes.set_title("( ): above half the rate, folded", fontsize=8, fontweight="normal", pad=24.0)
    for k, (at, texts) in enumerate(sorted(places.items())):
        axes.axvline(at, color=MARKER_COLOUR, linewidth=0.8, linestyle=":", zorder=0.5)
        axes.text(at, 1.0 + _LIFT * (k % 2), " ".join(texts), ha="center", va="bottom", fontsize=8,
                  transform=axes.get_xaxis_transform(), color=MARKER_COLOUR)  # fmt: skip

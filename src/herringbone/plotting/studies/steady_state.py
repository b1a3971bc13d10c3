"""A steady state: its signals over one period, its orders, and its Floquet multipliers."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from herringbone.analysis.steady.periodic import PeriodicMotion
from herringbone.analysis.steady.state import SteadyState
from herringbone.core.declaring.units import R_MIN
from herringbone.plotting.studies.coinciding import coinciding
from herringbone.plotting.style import (
    COLOURS,
    MARKER_COLOUR,
    legend,
    new_figure,
    scaled_unit,
    styled,
)

_LOUDEST = 4
_STYLES = ("-", "--") * (_LOUDEST // 2)
"""Of their lines: halves are as loud as each other, and one hides the other unless it has gaps."""
_FEW = 10
"""Meshes of a period whose multipliers take no second."""
_WORDS = 2
"""Of a column's name, from its end, that are shown."""
_PLACES = 512
_MESHES = 6
"""Of a long period, so many meshes are drawn at most."""
_DECADES = 1e-4
_ROOM = 0.06
"""Of a panel's height, below the curves for each line of text."""
_ORDERS = 12.0
"""Mesh orders that are drawn."""


@styled
def steady_picture(state: PeriodicMotion) -> Figure:
    """One row per group of channels: its loudest signals over a period, and its orders.

    The last row has the multipliers in the complex plane, if they are known.
    """
    groups = list(state.channels)
    known = isinstance(state, SteadyState) and state.converged and state.meshes <= _FEW
    speed = f", {state.speed * R_MIN:.5g} r/min" if np.isfinite(state.speed) else ""
    word = "" if state.converged else " (NOT CONVERGED)"
    figure = new_figure(
        f"Steady state{word}: {state.system_name}{speed}", len(groups) + known, 2, width=13.0
    )
    panels = figure.subplots(len(groups) + known, 2, squeeze=False)
    for (left, right), group in zip(panels, groups, strict=False):
        _signals(left, state, group)
        _orders(right, state, group)
    if known and isinstance(state, SteadyState):
        _multipliers(panels[-1][0], state.multipliers.values)
        panels[-1][1].set_axis_off()
    return figure


def _signals(axes: Axes, state: PeriodicMotion, group: str) -> None:
    columns = state.chosen(group)
    sizes = np.sqrt((np.abs(state.amplitudes(group)[:, 1:]) ** 2).sum(axis=1))
    loudest = [columns[k] for k in np.argsort(-sizes, kind="stable")[:_LOUDEST]]
    share = min(1.0, _MESHES / state.meshes) if state.meshes else 1.0
    turn = np.linspace(0.0, share, _PLACES)
    values = np.array([
        state.signal(name, turn * state.period) - state.mean(name) for name in loudest
    ])  # fmt: skip
    factor, unit = scaled_unit(state.unit(columns[0]), float(np.abs(values).max(initial=0.0)))
    along, axis = turn * state.period * 1e3, "time [ms]"
    if state.meshes:
        along, axis = turn * state.meshes, "mesh periods"
    labels = short_names(loudest)
    for label, signal, style in zip(labels, values, _STYLES, strict=False):
        axes.plot(along, factor * signal, label=label, linestyle=style)
    more = f", the first {_MESHES} of {state.meshes} mesh periods" if share < 1.0 else ""
    same = coinciding(labels, [(along, signal) for signal in values])
    low, high = axes.get_ylim()
    axes.set_ylim(low - _ROOM * len(same) * (high - low), high)
    axes.text(
        0.01, 0.02, "\n".join(same), transform=axes.transAxes, fontsize=7.5,
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.0},
    )  # fmt: skip
    told = f"{group.replace('_', ' ')}, less its mean: loudest of {len(columns)}{more}"
    axes.set_title(told, fontsize=8.5, pad=18.0)
    axes.set_xlabel(axis)
    axes.set_ylabel(f"[{unit}]")
    legend(axes, _LOUDEST)


def short_names(columns: Sequence[str]) -> list[str]:
    """The last words of names; where these are alike, with the first one in front."""
    short = [".".join(name.split(".")[-_WORDS:]) for name in columns]
    return [
        f"{name.partition('.')[0]}: {ending}" if short.count(ending) > 1 else ending
        for name, ending in zip(columns, short, strict=True)
    ]


def _orders(axes: Axes, state: PeriodicMotion, group: str) -> None:
    """Amplitude of each harmonic, root mean square over the channels."""
    size = np.sqrt(np.mean(np.abs(state.amplitudes(group)[:, 1:]) ** 2, axis=0))
    order, label = state.frequencies[1:], "frequency [Hz]"
    if state.meshes:
        order, label = state.mesh_orders[1:], "mesh order"
        kept = order <= _ORDERS
        order, size = order[kept], size[kept]
    peak = float(size.max(initial=0.0))
    factor, unit = scaled_unit(state.unit(state.chosen(group)[0]), peak)
    shown = size > _DECADES * peak
    axes.vlines(order[shown], factor * _DECADES * peak, factor * size[shown], color=COLOURS[0])
    axes.plot(order[shown], factor * size[shown], "o", markersize=3.0, color=COLOURS[0])
    if peak > 0.0:
        axes.set_yscale("log")
    axes.set_title(f"{group.replace('_', ' ')}: amplitudes, pooled over channels", fontsize=8.5)
    axes.set_xlabel(label)
    axes.set_ylabel(f"[{unit}]")


def _multipliers(axes: Axes, values: np.ndarray) -> None:
    circle = np.exp(2j * np.pi * np.linspace(0.0, 1.0, 181))
    axes.plot(circle.real, circle.imag, color=MARKER_COLOUR, linewidth=0.8)
    axes.plot(values.real, values.imag, "x", color=COLOURS[0], markersize=5.0)
    axes.set_aspect("equal")
    axes.set_xlabel("real part")
    axes.set_ylabel("imaginary part")
    largest = float(np.abs(values).max(initial=0.0))
    word = "stable" if largest < 1.0 else "UNSTABLE"
    axes.set_title(f"Floquet multipliers of a period: {word}, largest {largest:.4g}", fontsize=8.5)

"""Vibration over speed: the thesis' points, and the curve between them."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.ground import SPEEDS, levels, natural, settled, unit, window, window_levels
from herringbone.thesis.pair.given import JOB
from herringbone.thesis.trends import growth, rises

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CURVE = np.arange(600.0, 1700.1, 5.0)
"""[r/min]."""
_POINTS = (800.0, 1200.0, 1500.0)
"""Of the thesis' tests; 1000 r/min is that of its other figures."""
_GROUND, _HOUSING, _WINDOW = "rigid ground", "two-way housing", "window"
_SHOWN = (
    "pinion axial velocity",
    "pinion radial velocity",
    "wheel axial velocity",
    "wheel radial velocity",
    "pinion radial displacement",
    "wheel radial displacement",
)
_AXIAL, _RADIAL = _SHOWN[:2]
_HIGHEST = 3
"""Mesh order up to which natural frequencies are looked for."""


def compute() -> Outcome:
    """Curves by steady states, points in the window of the thesis."""
    rows: list[dict[str, float | str]] = []
    for seen in (_GROUND, _HOUSING):
        states = settled(CURVE, seats_move=seen == _HOUSING)
        for speed, state in zip(CURVE, states, strict=True):
            rows.append(_row(seen, speed, levels(state)))
    for speed in SPEEDS:
        rows.append(_row(_WINDOW, speed, window_levels(window(speed))))
    units = {"speed": "r/min"} | {name: unit(name) for name in _SHOWN}
    curves = table(pd.DataFrame(rows), units)
    crossings = table(pd.DataFrame(_crossings()), {"speed": "r/min", "frequency": "Hz"})
    return Outcome({"curves": curves, "crossings": crossings}, _findings(curves))


def _row(seen: str, speed: float, found: Mapping[str, float]) -> dict[str, float | str]:
    return {"seen": seen, "speed": speed, **{name: found[name] for name in _SHOWN}}


def _crossings() -> list[dict[str, float]]:
    """Speeds at which mesh orders meet natural frequencies on rigid ground."""
    teeth = JOB.pair.number_of_teeth[0]
    found = [
        {"speed": 60.0 * frequency / (order * teeth), "order": order, "frequency": frequency}
        for frequency in natural().frequency_hz
        for order in range(1, _HIGHEST + 1)
    ]
    return [row for row in found if CURVE[0] <= row["speed"] <= CURVE[-1]]


def _findings(curves: pd.DataFrame) -> tuple[Finding, ...]:
    by = {seen: rows.set_index("speed") for seen, rows in curves.groupby("seen")}
    ground = by[_GROUND]
    axial = ground[_AXIAL]
    between = axial[(axial.index >= SPEEDS[0]) & (axial.index <= SPEEDS[-1])]
    return (
        Finding(
            "From 800 to 1500 r/min the axial velocity of the pinion grows: settled.",
            Verdict.of(rises(axial[list(SPEEDS)]) and rises(between, least=0.0)),
            growth(axial[list(SPEEDS)].to_numpy()),
            "%",
            "change, on the whole curve: a displacement that turns with the pinion",
            "Its mesh harmonics are 30 times smaller.",
            margin=0.1,
        ),
        Finding(
            "The same, in the window of the thesis.",
            Verdict.of(rises(by[_WINDOW][_AXIAL])),
            growth(by[_WINDOW][_AXIAL].to_numpy()),
            "%",
            "change from 800 to 1500 r/min",
            "The decay of the start hides the operating point.",
            margin=1.0,
        ),
        *_radial(ground[_RADIAL], _GROUND),
        *_radial(by[_HOUSING][_RADIAL], _HOUSING),
        _pinion_and_wheel(ground),
    )


def _radial(level: pd.Series, seen: str) -> tuple[Finding, ...]:
    """Three points against four and the curve."""
    peak = _highest_between(level, _POINTS)
    ratio = float(level[peak] / level[next(p for p in _POINTS if p > peak)])
    four = ", ".join(f"{level[speed]:.3f}" for speed in SPEEDS)
    return (
        Finding(
            f"Vibration and its fluctuation grow with speed (radial, {seen}).",
            Verdict.of(rises(level[list(SPEEDS)])),
            ratio,
            "",
            f"times the level at the next point has the resonance at {peak:.0f} r/min, which the "
            f"points 800, 1200, 1500 r/min hide; {four} mm/s at 800, 1000, 1200, 1500 r/min",
            "Three points " + ("rise" if rises(level[list(_POINTS)]) else "do not rise either")
            + "; the curve between them has resonances.",
            margin=0.05,
        ),
    )  # fmt: skip


def _highest_between(level: pd.Series, points: Sequence[float]) -> float:
    """Speed of the highest level between the first two points."""
    inside = level[(level.index > points[0]) & (level.index < points[1])]
    return float(inside.idxmax())


def _pinion_and_wheel(ground: pd.DataFrame) -> Finding:
    ratio = ground["pinion radial displacement"] / ground["wheel radial displacement"]
    ratio = ratio[(ratio.index >= SPEEDS[0]) & (ratio.index <= SPEEDS[-1])]
    at = float(ratio.idxmin())
    less = ratio.index[ratio < 1.0]
    span = f"{less.min():.0f} to {less.max():.0f} r/min" if len(less) else "nowhere"
    return Finding(
        "The pinion vibrates more than the wheel, at any speed.",
        Verdict.of((ratio > 1.0).all()),
        float(ratio[at]),
        "",
        f"times the wheel's radial displacement has the pinion at {at:.0f} r/min; less than the "
        f"wheel from {span}",
        "There the mesh frequency meets the wheel's radial mode at 562 Hz.",
        margin=0.02,
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Curves, the thesis' speeds, and where mesh orders meet natural frequencies."""
    from herringbone.plotting.style import COLOURS, figure_legend, new_figure  # noqa: PLC0415 (lazy)

    figure = new_figure("200 N m, f_A 10 µm: rms over speed, settled", 3, 2)
    panels = list(figure.subplots(3, 2, sharex=True).flat)
    curves = tables["curves"]
    for axes, name in zip(panels, _SHOWN, strict=True):
        for seen, colour in ((_GROUND, COLOURS[0]), (_HOUSING, COLOURS[1])):
            rows = curves[curves["seen"] == seen]
            axes.semilogy(rows["speed"], rows[name], color=colour, label=seen)
            points = rows[rows["speed"].isin(SPEEDS)]
            axes.plot(points["speed"], points[name], "o", color=colour, markersize=5.0)
        for _, crossing in tables["crossings"].iterrows():
            axes.axvline(crossing["speed"], color="#999999", linewidth=0.7, linestyle=":")
            if axes in panels[:2]:
                axes.text(crossing["speed"], 1.0, f"{crossing['order']:.0f} f_m",
                          transform=axes.get_xaxis_transform(), rotation=90, fontsize=7,
                          ha="right", va="top")  # fmt: skip
        axes.set_title(f"{name} [{unit(name)}]")
        axes.margins(x=0.0)
    for axes in panels[-2:]:
        axes.set_xlabel("speed [r/min]; dots: 800, 1000, 1200, 1500; dotted: mesh order meets mode")
    figure_legend(figure, panels[0])
    return {"speed": figure}


ENTRY = Entry(
    name="input_speed",
    group="dynamics",
    title="Influence of the speed, and the curve between the points",
    source="chapter 3.5",
    shows="Axial velocity for speeds from 800 to 1500 r/min at constant torque: vibration and its "
    "fluctuation are said to grow with speed.",
    compute=compute,
    draw=draw,
    seconds=15.0,
)

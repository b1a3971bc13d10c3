"""The speed curve between the few speeds of the thesis."""

import math
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.ground import natural
from herringbone.thesis.names import RIG
from herringbone.thesis.pair.given import JOB
from herringbone.thesis.readings.measures import LEVEL, SETTLED, measures
from herringbone.thesis.readings.motion import Moving
from herringbone.thesis.readings.points import SPEEDS, TORQUE
from herringbone.thesis.readings.reading import AS_SHIPPED, GROUND, Reading

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_CURVE = tuple(float(n) for n in range(800, 1501, 10))
_DEVIATION = 10e-6
_READINGS: dict[str, Reading] = {
    "as shipped": AS_SHIPPED,
    "pinion held, 1e8 N/m": AS_SHIPPED.but(restraint=1e8),
    "bearings on ground; f_A stands still": AS_SHIPPED.but(foundation=GROUND, run_out="still"),
}
_WHAT = {
    "pinion.v_z": "pinion, axial",
    "pinion.v_y": "pinion, radial",
    "A": "sensor A, axial",
}
_MM = 1e3
_ORDERS = 2
"""Mesh harmonics that are looked at."""
_SEEN = 5.0
"""A fall that a printed figure shows [%]."""


def compute() -> Outcome:
    """Levels over speed for a few readings."""
    rows = []
    for words, reading in _READINGS.items():
        moving = Moving(reading)
        for speed in _CURVE:
            found = measures(moving.at(_DEVIATION, TORQUE, speed * math.pi / 30.0))
            levels = {what: _MM * found[what, LEVEL, SETTLED] for what in _WHAT}
            rows.append({"reading": words, "speed": speed, **levels})
    frame = pd.DataFrame(rows)
    curve = table({name: frame[name] for name in frame},
                  {"speed": "r/min", **dict.fromkeys(_WHAT, "mm/s")})  # fmt: skip
    told = [_finding(curve, what) for what in ("pinion.v_z", "A")]
    return Outcome({"curves": curve}, (*told, _resonance()))


def _finding(curve: pd.DataFrame, what: str) -> Finding:
    """Whether a level grows over the thesis' speeds, and over those in between, as shipped."""
    own = curve[curve["reading"] == next(iter(_READINGS))].set_index("speed")[what]
    at_points = bool((np.diff(own[list(SPEEDS)].to_numpy()) > 0.0).all())
    fall = 100.0 * (own / own.cummax() - 1.0)
    deepest = float(fall.idxmin())
    peak = float(own[own.index <= deepest].idxmax())
    where = f", from {peak:.0f} to {deepest:.0f} r/min" if fall.min() < 0.0 else ""
    words = f"at the points it {'grows' if at_points else 'does not grow'}"
    grows = float(fall.min()) > -_SEEN
    return Finding(
        f"Axial velocity grows from 800 to 1500 r/min ({_WHAT[what]}).",
        Verdict.of(grows and at_points),
        float(fall.min()),
        "%",
        f"is the deepest fall of the level{where}; {words}",
        "On the speed curve, as shipped; resonances with mesh harmonics lie between the points.",
        0.5,
    )


def _resonance() -> Finding:
    """Of mesh orders near natural frequencies of the rig: within half of a half-power bandwidth."""
    modes, teeth = natural(RIG), JOB.pair.number_of_teeth[0]

    def nearest(speed: float) -> tuple[float, float, int]:
        """Distance over half a bandwidth, natural frequency [Hz], and mesh order."""
        return min(
            (abs(order * teeth * speed / 60.0 / f - 1.0) / z, f, order)
            for order in range(1, _ORDERS + 1)
            for f, z in zip(modes.frequency_hz, modes.damping_ratio, strict=True)
        )

    last = SPEEDS[-1]
    distance, frequency, order = nearest(last)
    met = 100.0 * float(np.mean([nearest(speed)[0] < 1.0 for speed in _CURVE]))
    return Finding(
        f"At {last:.0f} r/min there is possibly a resonance near a natural frequency.",
        Verdict.of(distance < 1.0),
        frequency,
        "Hz",
        f"is a natural frequency of the rig, which mesh harmonic {order} meets at {last:.0f} r/min "
        f"({order * teeth * last / 60.0:.0f} Hz) by {distance:.1f} of half its bandwidth",
        f"So does one of {_ORDERS} mesh harmonics at {met:.0f} % of the speeds of the curve: it "
        "does not set this speed apart.",
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Levels over speed, with the speeds of the thesis."""
    from herringbone.plotting.style import MARKER_COLOUR, figure_legend, new_figure  # noqa: PLC0415

    curves = tables["curves"]
    figure = new_figure("Levels over speed, 200 N m, f_A 10 µm; points: speeds of the thesis", 1,
                        len(_WHAT), width=15.0)  # fmt: skip
    panels = figure.subplots(1, len(_WHAT))
    for axes, (what, words) in zip(panels, _WHAT.items(), strict=True):
        for reading, part in curves.groupby("reading", sort=False):
            (line,) = axes.plot(part["speed"], part[what], label=reading)
            own = part[part["speed"].isin(SPEEDS)]
            axes.plot(own["speed"], own[what], "o", color=line.get_color(), markersize=4)
        for speed in SPEEDS:
            axes.axvline(speed, color=MARKER_COLOUR, linewidth=0.7, linestyle=":")
        axes.set_yscale("log")
        axes.set_title(words)
        axes.set_xlabel("speed [r/min]")
    panels[0].set_ylabel("rms [mm/s]")
    figure_legend(figure, panels[0])
    return {"curves": figure}


ENTRY = Entry(
    name="speed_between_points",
    group="readings",
    title="The speed curve between the points",
    source="chapters 3.5 and 5.3.2",
    shows="Axial velocity grows with speed: of the pinion at 800 to 1500 r/min, of the housing at "
    "800, 1200 and 1500 r/min. Here the curve in steps of 10 r/min, for three readings.",
    compute=compute,
    draw=draw,
    seconds=10.0,
)

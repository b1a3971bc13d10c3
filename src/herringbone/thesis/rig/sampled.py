"""What sensors A, B, C sample on the plateaus of a test cycle, by the accuracy of the teeth."""

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from herringbone.analysis.figures.sensing.plateaus import SAMPLES, plateau_statistics
from herringbone.analysis.figures.sensing.sensors import sensor_figures
from herringbone.core.declaring.units import R_MIN
from herringbone.thesis.entry import table
from herringbone.thesis.rig.runs import SENSORS, TEETH, cycle_run

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MM = 1e3
_FIGURES = ("rms", "peak_to_peak", "rms_settled", "lowest", "highest")
_TORQUE_RATIO = 3.0
"""Torque set point of the load motor over that of the pinion."""
LITTLE = 0.25
"""Difference between sensors that does not count."""


def statistics(cycle: str, classes: Sequence[str]) -> pd.DataFrame:
    """A row per class of the teeth, plateau and sensor: figures in mm/s."""
    parts = []
    for words in classes:
        part = plateau_statistics(cycle_run(cycle, TEETH[words]))
        part.insert(0, "teeth", words)
        parts.append(part)
    found = pd.concat(parts, ignore_index=True)
    return table(
        {
            "teeth": found["teeth"],
            "speed": np.rint(R_MIN * found["speed"]),
            "torque": np.rint(found["torque"] / _TORQUE_RATIO),
            "sensor": found["sensor"],
            **{name: _MM * found[name] for name in _FIGURES},
        },
        {"speed": "r/min", "torque": "N m", **dict.fromkeys(_FIGURES, "mm/s")},
    )


def samples(cycle: str, stats: pd.DataFrame, classes: tuple[str, ...]) -> pd.DataFrame:
    """The samples that are taken at the end of each plateau [mm/s]."""
    parts = []
    for words in classes:
        result = cycle_run(cycle, TEETH[words])
        taken = plateau_statistics(result)
        places = stats[(stats["teeth"] == words)].reset_index(drop=True)
        found, _ = sensor_figures(result)
        for k, row in enumerate(taken.itertuples()):
            one = found[str(row.sensor)]
            last = np.flatnonzero(one.time <= row.end)[-SAMPLES:]
            parts.append(
                pd.DataFrame(
                    {
                        "teeth": words,
                        "speed": places["speed"][k],
                        "torque": places["torque"][k],
                        "sensor": row.sensor,
                        "time": 1e3 * (one.time[last] - one.time[last[0]]),
                        "velocity": _MM * one.velocity[last],
                    }
                )
            )
    found_all = pd.concat(parts, ignore_index=True)
    return table(
        {name: found_all[name] for name in found_all},
        {"speed": "r/min", "torque": "N m", "time": "ms", "velocity": "mm/s"},
    )


def spread(stats: pd.DataFrame, teeth: str, speeds: tuple[float, ...]) -> float:
    """What the largest sensor exceeds the least by, at the worst of some speeds."""
    chosen = stats[(stats["teeth"] == teeth) & stats["speed"].isin(speeds)]
    levels = chosen.groupby("speed")["rms_settled"]
    return float((levels.max() / levels.min()).max() - 1.0)


def growth(stats: pd.DataFrame, teeth: str, along: str, figure: str = "rms_settled") -> float:
    """Least relative step of a figure along speed or torque, over all sensors."""
    chosen = stats[stats["teeth"] == teeth].sort_values(along)
    steps = [
        after / before - 1.0
        for name in SENSORS
        for before, after in pairwise(chosen[chosen["sensor"] == name][figure])
    ]
    return min(steps)


def level_picture(stats: pd.DataFrame, along: str, unit: str) -> "Figure":
    """Levels over speed or torque, by class and sensor, with the scatter of 50 samples."""
    from herringbone.plotting.style import new_figure  # noqa: PLC0415 (matplotlib: lazy)

    title = f"Level over {along} by class of the teeth; shaded: rms of any 50 samples (A)"
    figure = new_figure(title, 1, width=9.0)
    _draw_levels(figure.subplots(), stats, along, unit)
    figure.subplots_adjust(right=0.78)
    return figure


def _draw_levels(axes: "Axes", stats: pd.DataFrame, along: str, unit: str) -> None:
    from herringbone.plotting.style import COLOURS, legend_beside  # noqa: PLC0415

    styles = dict(zip(SENSORS, ("-", "--", ":"), strict=True))
    for colour, words in zip(COLOURS, stats["teeth"].unique(), strict=False):
        for name in SENSORS:
            own = stats[(stats["teeth"] == words) & (stats["sensor"] == name)]
            how: dict[str, Any] = {"color": colour, "linestyle": styles[name]}
            axes.plot(own[along], own["rms_settled"], marker=".", label=f"{words}, {name}", **how)
            if name == SENSORS[0]:
                low, high = own["lowest"], own["highest"]
                axes.fill_between(own[along], low, high, color=colour, alpha=0.15)
    axes.set_yscale("log")
    axes.set_xlabel(f"{along} [{unit}]")
    axes.set_ylabel("rms [mm/s]")
    legend_beside(axes)

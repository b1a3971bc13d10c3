"""Figures 5.3 and 5.4: sensors A, B, C at 800, 1200 and 1500 r/min."""

from typing import TYPE_CHECKING

import pandas as pd

from herringbone.core.wording import percent
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict
from herringbone.thesis.rig.runs import REAL, SENSORS, SPEEDS, TEETH
from herringbone.thesis.rig.sampled import (
    LITTLE,
    growth,
    level_picture,
    samples,
    spread,
    statistics,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PERFECT = "perfect"
_LOW, _HIGH = (800.0, 1200.0), 1500.0
_RANGE = 50.0
"""Of the sensors [mm/s]."""


def compute() -> Outcome:
    """Statistics of the plateaus for all classes of teeth, and the samples of two of them."""
    stats = statistics(SPEEDS, tuple(TEETH))
    return Outcome(
        {"plateaus": stats, "samples": samples(SPEEDS, stats, (_PERFECT, REAL))},
        (*_of_positions(stats), _of_speed(stats), *_of_sampling(stats)),
    )


def _at_high(stats: pd.DataFrame, teeth: str) -> pd.DataFrame:
    """Statistics at the highest speed, by sensor."""
    return stats[(stats["speed"] == _HIGH) & (stats["teeth"] == teeth)].set_index("sensor")


def _of_positions(stats: pd.DataFrame) -> tuple[Finding, ...]:
    """Of what the sensors differ by at the lower speeds, and at the highest one."""
    alike = {words: spread(stats, words, _LOW) for words in (_PERFECT, REAL)}
    real, perfect = (_at_high(stats, words)["rms_settled"] for words in (REAL, _PERFECT))
    return (
        Finding(
            "At 800 and 1200 r/min the sensor's position does not matter (figure 5.3).",
            Verdict.needing(alike[_PERFECT] <= LITTLE, alike[REAL] <= LITTLE),
            100.0 * alike[_PERFECT],
            "%",
            "the largest of A, B, C exceeds the least with perfect teeth; "
            f"{100.0 * alike[REAL]:.1f} % with teeth of {REAL}",
            f"Up to {100.0 * LITTLE:.0f} % are called alike. Teeth that deviate excite other modes "
            "than mesh harmonics of perfect ones.",
            2.0,
        ),
        Finding(
            "At 1500 r/min the velocity grows from A over B to C (figure 5.3).",
            Verdict.of(real["C"] / real["A"] > 1.0 + LITTLE),
            real["C"] / real["A"],
            "",
            f"is C over A with teeth of {REAL}; {perfect['C'] / perfect['A']:.2f} with perfect "
            "ones",
            "It depends on the shape of the housing, of which no dimension is published.",
            0.02,
        ),
    )


def _of_speed(stats: pd.DataFrame) -> Finding:
    rising = {words: growth(stats, words, "speed") for words in (_PERFECT, REAL)}
    return Finding(
        "The velocity grows with speed (figure 5.4).",
        Verdict.needing(rising[_PERFECT] > 0.0, rising[REAL] > 0.0),
        100.0 * rising[_PERFECT],
        "%",
        f"is the least step with perfect teeth, {100.0 * rising[REAL]:+.0f} % with teeth of {REAL}",
        "Three speeds say little: see the speed curve.",
        2.0,
    )


def _of_sampling(stats: pd.DataFrame) -> tuple[Finding, ...]:
    """Of the sensors' range, and of what 50 samples tell."""
    high, perfect = (_at_high(stats, words) for words in (REAL, _PERFECT))
    return (
        Finding(
            "Sensors have a range of 50 mm/s; no level is published.",
            Verdict.CANNOT_BE_TESTED,
            100.0 * float(high["rms_settled"].max()) / _RANGE,
            "%",
            f"of the range is the largest rms at 1500 r/min with teeth of {REAL}, and "
            f"{percent(float(perfect['rms_settled'].max()) / _RANGE)} with perfect ones",
            "",
            0.1,
        ),
        Finding(
            "50 samples were recorded at each speed.",
            Verdict.NEEDS_AN_ASSUMPTION,
            float((high["highest"] / high["lowest"]).max()),
            "",
            f"times the least rms of 50 samples is the largest one at 1500 r/min (teeth of {REAL})",
            "They last 25 ms, less than a turn of either shaft at 1500 r/min: the number that is "
            "read depends on where they begin.",
            0.05,
        ),
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Samples by position and speed; levels over speed."""
    from herringbone.plotting.style import new_figure  # noqa: PLC0415 (matplotlib: lazy)

    found = tables["samples"]
    speeds = sorted(found["speed"].unique())
    positions = new_figure("Axial velocity at A, B, C: the last 50 samples of each plateau (5.3)",
                           2, len(speeds))  # fmt: skip
    panels = positions.subplots(2, len(speeds))
    for row, words in zip(panels, (_PERFECT, REAL), strict=True):
        top = found[found["teeth"] == words]["velocity"].abs().max()
        for axes, speed in zip(row, speeds, strict=True):
            for name in SENSORS:
                own = found[(found["teeth"] == words) & (found["speed"] == speed)]
                own = own[own["sensor"] == name]
                axes.plot(own["time"], own["velocity"], marker=".", markersize=3, label=name)
            axes.set_ylim(-1.1 * top, 1.1 * top)
            axes.set_title(f"{speed:.0f} r/min, {words} teeth" if words == _PERFECT
                           else f"{speed:.0f} r/min, teeth of {words}")  # fmt: skip
            axes.set_xlabel("time [ms]")
        row[0].set_ylabel("velocity [mm/s]")
    panels[0, -1].legend(loc="upper right", ncols=3)
    return {"positions": positions, "levels": level_picture(tables["plateaus"], "speed", "r/min")}


ENTRY = Entry(
    name="sensors_over_speed",
    group="rig",
    title="Sensors A, B, C over speed",
    source="chapters 5.3.1 and 5.3.2, figures 5.3 and 5.4",
    shows="Axial velocity of the input shaft's bearing housing at 90, 180 and 270 degrees, 800, "
    "1200 and 1500 r/min: alike at the lower speeds, growing from A to C at the highest one, and "
    "growing with speed. Sampled here by 2000 Hz, 16 bits over 50 mm/s, at 200 N m, f_A 10 µm.",
    compute=compute,
    draw=draw,
    seconds=8.0,
)

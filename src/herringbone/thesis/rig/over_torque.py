"""Figure 5.5: the sensors over torque at 1000 r/min."""

from typing import TYPE_CHECKING

import pandas as pd

from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict
from herringbone.thesis.rig.runs import REAL, TEETH, TORQUES
from herringbone.thesis.rig.sampled import growth, level_picture, samples, statistics

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PERFECT = "perfect"
_SENTENCES = {
    "The velocity grows monotonically with torque": "rms_settled",
    "Its fluctuation grows with torque, too": "highest",
}
_SHOWN = 100.0, 200.0, 400.0
"""Torques of which samples are drawn [N m]."""


def compute() -> Outcome:
    """Statistics of the plateaus for all classes of teeth, and the samples of two of them."""
    stats = statistics(TORQUES, tuple(TEETH))
    return Outcome(
        {"plateaus": stats, "samples": samples(TORQUES, stats, (_PERFECT, REAL))},
        tuple(
            _growing(stats, words, sentence, figure)
            for sentence, figure in _SENTENCES.items()
            for words in (_PERFECT, REAL)
        ),
    )


def _growing(stats: pd.DataFrame, teeth: str, sentence: str, figure: str) -> Finding:
    least = 100.0 * growth(stats, teeth, "torque", figure)
    why = (
        "The deflection grows with torque, and so does what its variation excites."
        if teeth == _PERFECT
        else "Deviations do not grow with torque, and weigh less the deeper the teeth are pressed "
        "into each other."
    )
    return Finding(
        f"{sentence} (figure 5.5): {_told(teeth)}.",
        Verdict.of(least > 0.0),
        least,
        "%",
        "is the least step from 100 to 400 N m",
        why,
        2.0,
    )


def _told(teeth: str) -> str:
    return "perfect teeth" if teeth == _PERFECT else f"teeth of {teeth}"


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Samples at sensor A by torque; levels over torque."""
    from herringbone.plotting.style import new_figure  # noqa: PLC0415 (matplotlib: lazy)

    found = tables["samples"]
    found = found[found["sensor"] == "A"]
    traces = new_figure("Axial velocity at A, 1000 r/min: last 50 samples of each plateau (5.5)",
                        1, 2)  # fmt: skip
    for axes, words in zip(traces.subplots(1, 2), (_PERFECT, REAL), strict=True):
        own = found[found["teeth"] == words]
        for torque, part in own[own["torque"].isin(_SHOWN)].groupby("torque"):
            axes.plot(part["time"], part["velocity"], marker=".", markersize=3,
                      label=f"{torque:.0f} N m")  # fmt: skip
        axes.set_title(_told(words))
        axes.set_xlabel("time [ms]")
        axes.set_ylabel("velocity [mm/s]")
        axes.margins(y=0.25)
    axes.legend(loc="upper right", ncols=3)
    return {"samples": traces, "levels": level_picture(tables["plateaus"], "torque", "N m")}


ENTRY = Entry(
    name="sensors_over_torque",
    group="rig",
    title="Sensors A, B, C over torque",
    source="chapter 5.3.3, figure 5.5",
    shows="Axial velocity at 1000 r/min while the torque rises from 100 over 200, 270, 300 and 350 "
    "to 400 N m: it grows monotonically. Sampled here as over speed, at f_A 10 µm.",
    compute=compute,
    draw=draw,
    seconds=25.0,
)

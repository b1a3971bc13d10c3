"""At which torque each reading of the thesis' relief gives its -0.95 %."""

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.pair.finite_elements import TORQUES, by_elements
from herringbone.thesis.pair.given import JOB
from herringbone.thesis.pair.methods import PUBLISHED
from herringbone.thesis.pair.methods import torque_of as torque_of_stiffness
from herringbone.thesis.pair.relief.readings import (
    AMOUNTS,
    PUBLISHED_CHANGE,
    READINGS,
    TIPS,
    TOLD,
    change,
    change_at,
    change_by,
    torque_of,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_TEN = AMOUNTS[1]
_PLACES: dict[str, dict[str, Any]] = {
    "pinion": {"xytext": (-5.0, -11.0), "ha": "right"},
    "both": {"xytext": (5.0, 6.0), "ha": "center"},
}
"""Of the labels of the torques, beside their points."""


def compute() -> Outcome:
    """Changes over torque, and the torque of each reading."""
    rows = [
        (tips, amount, reading, torque, value)
        for tips in TIPS
        for amount in AMOUNTS
        for reading in READINGS
        for torque, value in zip(TORQUES, change(tips, amount, reading), strict=True)
    ]
    changes = pd.DataFrame(rows, columns=["tips", "relief", "reading", "torque", "change"])
    reached, methods = _reached(), _by_method()
    units = {"torque": "N.m", "relief": "um", "change": "%", "line_load": "N/mm"}
    units |= {"stiffness": "N/m", "at_stiffness": "%"}
    return Outcome(
        {
            "reached": table(reached.to_dict("list"), units),
            "methods": table(methods.to_dict("list"), units),
            "changes": table(changes.to_dict("list"), units),
        },
        _findings(reached, methods),
    )


def _reached() -> pd.DataFrame:
    """A row per reading: torque of -0.95 %, load there, stiffness there, change at 2.011e9 N/m."""
    plain, rows = 2.0 * READINGS["mean"](by_elements()), []
    of_stiffness = torque_of_stiffness(PUBLISHED, np.array(TORQUES), plain)
    for tips in TIPS:
        for reading in READINGS:
            changes = change(tips, _TEN, reading)
            torque = torque_of(changes)
            force = torque / JOB.pair.reference_radius[0]
            line = 1e-3 * force / (2.0 * JOB.pair.face_width)
            stiffness = np.interp(np.log(torque), np.log(TORQUES), plain)
            there = change_at(changes, of_stiffness)
            rows.append((tips, reading, torque, line, float(stiffness), there))
    names = ["tips", "reading", "torque", "line_load", "stiffness", "at_stiffness"]
    return pd.DataFrame(rows, columns=names)


def _by_method() -> pd.DataFrame:
    """Torque of -0.95 % of the mean, by finite elements and by slices."""
    rows = [
        (tips, title, torque_of(changes))
        for tips in TIPS
        for title, changes in (
            ("finite elements", change(tips, _TEN, "mean")),
            ("coupled slices", change_by("coupled-slices", tips)),
            ("plain slices", change_by("slices", tips)),
        )
    ]
    return pd.DataFrame(rows, columns=["tips", "method", "torque"])


def _findings(reached: pd.DataFrame, methods: pd.DataFrame) -> tuple[Finding, ...]:
    slices = methods.set_index(["tips", "method"])["torque"][("pinion", "plain slices")]
    at = reached.set_index(["tips", "reading"])
    every = "; ".join(
        f"{TOLD[reading]}, {TIPS[tips]}: {_torque(row['torque'])}"
        for (tips, reading), row in at.iterrows()
    )
    nearest = (reached["at_stiffness"] - PUBLISHED_CHANGE).abs().idxmin()
    best = reached.loc[nearest]
    mean = at.loc[("pinion", "mean")]
    return (
        Finding(
            "10 µm of relief reduce the stiffness by 0.95 %.",
            Verdict.NEEDS_AN_ASSUMPTION,
            mean["torque"],
            "N m",
            f"at the pinion, where the mean Fₙ/δₙ does so by relief at its tip: "
            f"{mean['line_load']:.0f} N/mm",
            f"Torque of each reading: {every}. By plain slices, whose lines have no support at "
            f"their ends, the first is {slices:.0f} N m.",
            margin=50.0,
        ),
        Finding(
            "The stiffness falls from 2.011·10⁹ to 1.992·10⁹ N/m.",
            Verdict.NEEDS_AN_ASSUMPTION,
            best["at_stiffness"],
            "%",
            "by 10 µm at the torque at which the mean stiffness is 2.011·10⁹ N/m: the nearest of "
            f"all readings, {TOLD[best['reading']]}, {TIPS[best['tips']]}",
            f"By the thesis' own definition, Fₙ/δₙ, it is {mean['at_stiffness']:.1f} % there: the "
            "figures meet only if the stiffness is read as Fₙ/δₙ and its change as that of the "
            "tangent, which falls steeply there.",
            margin=0.02,
        ),
    )


def _torque(value: float) -> str:
    return "not up to the largest" if np.isnan(value) else f"{value:.0f} N m"


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Changes over torque, a panel for each reading."""
    from herringbone.plotting.style import COLOURS, new_figure  # noqa: PLC0415 (lazy)

    changes, reached = tables["changes"], tables["reached"]
    figure = new_figure("Change of the mesh stiffness by relief", 1, len(READINGS))
    for axes, reading in zip(figure.subplots(1, len(READINGS)), READINGS, strict=True):
        for colour, (tips, where) in zip(COLOURS, TIPS.items(), strict=False):
            for amount, dash in zip(AMOUNTS, ((0, (4, 2)), "-"), strict=True):
                one = changes[
                    (changes["tips"] == tips)
                    & (changes["relief"] == amount)
                    & (changes["reading"] == reading)
                ]
                axes.loglog(
                    one["torque"], -one["change"], color=colour, linestyle=dash,
                    label=f"{amount:g} µm {where}",
                )  # fmt: skip
            at = reached[(reached["tips"] == tips) & (reached["reading"] == reading)].iloc[0]
            if np.isnan(at["torque"]):
                continue
            axes.plot(at["torque"], -PUBLISHED_CHANGE, "o", color=colour, markersize=5.0)
            axes.annotate(
                f"{at['torque']:.0f} N m", (at["torque"], -PUBLISHED_CHANGE),
                textcoords="offset points", fontsize=8.0, color=colour,
                bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5}, **_PLACES[tips],
            )  # fmt: skip
        axes.axhline(-PUBLISHED_CHANGE, color="black", linestyle=":")
        axes.set_title(TOLD[reading], fontsize=9.0)
        axes.set_xlabel("torque of the pinion [N m]")
        axes.set_ylim(0.02, 40.0)
    figure.axes[0].set_ylabel("loss of stiffness [%]")
    figure.axes[0].text(60.0, -PUBLISHED_CHANGE, "thesis, 10 µm", va="bottom", fontsize=8.0)
    figure.axes[0].legend(loc="lower left")
    return {"relief_over_torque": figure}


ENTRY = Entry(
    name="relief_over_torque",
    group="pair",
    title="The torque of the relief's 0.95 %",
    source="chapter 2.4",
    shows="10 µm of relief take 0.95 % off the stiffness, from 2.011·10⁹ to 1.992·10⁹ N/m; the "
    "torque is not stated, nor which tips are relieved, nor what of the curve is its amplitude.",
    compute=compute,
    draw=draw,
    seconds=8.0,
)

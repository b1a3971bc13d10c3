"""Stiffness over a mesh period with relief, figure 2.5."""

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.gears import MeshStiffness
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.pair.finite_elements import TORQUES, by_elements
from herringbone.thesis.pair.periods import two_periods
from herringbone.thesis.pair.relief.readings import AMOUNTS, TIPS, change, relief

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SHOWN = (200.0, 2000.0, 8000.0)
"""Torques [N m]: of the thesis' dynamics, near its stiffness, near its change by 10 um."""


def compute() -> Outcome:
    """Curves at some torques, and changes of their means."""
    rows, means = [], []
    for torque in _SHOWN:
        at = TORQUES.index(torque) + 1
        plain = by_elements().secant[at]
        for tips in TIPS:
            for amount in (0.0, *AMOUNTS):
                found = by_elements() if amount == 0.0 else relief(tips, amount)
                curve = found.secant[at]
                each = zip(found.phases, 2.0 * curve, strict=True)
                rows += [(torque, tips, amount, *values) for values in each]
                changed = 100.0 * (curve.mean() / plain.mean() - 1.0)
                means.append(
                    (torque, tips, amount, 2.0 * curve.mean(), changed, _ripple(found, at))
                )
    keys = ["torque", "tips", "relief"]
    units = {"torque": "N.m", "relief": "um", "phase": "mesh periods", "k": "N/m"}
    units |= {"change": "%", "peak_to_peak": "%"}
    curves = pd.DataFrame(rows, columns=[*keys, "phase", "k"])
    told = pd.DataFrame(means, columns=[*keys, "k", "change", "peak_to_peak"])
    return Outcome(
        {
            "means": table(told.to_dict("list"), units),
            "curves": table(curves.to_dict("list"), units),
        },
        _findings(told.set_index(keys)),
    )


def _ripple(found: MeshStiffness, at: int) -> float:
    """Peak to peak of the stiffness over its mean [%]."""
    return 100.0 * float(np.ptp(found.secant[at]) / found.secant[at].mean())


def _findings(means: pd.DataFrame) -> tuple[Finding, ...]:
    low = _SHOWN[0]
    rises = max(float(change(tips, AMOUNTS[0], "mean").max()) for tips in TIPS)
    tangent = max(float(change(tips, AMOUNTS[0], "tangent").max()) for tips in TIPS)
    plain, ten = (means.loc[(low, "both", amount)] for amount in (0.0, AMOUNTS[1]))
    relieved = means.drop(0.0, level="relief")
    without = means.xs(0.0, level="relief")["peak_to_peak"]
    ripple = relieved["peak_to_peak"] / relieved.index.droplevel("relief").map(without)
    return (
        Finding(
            "With 5 µm the stiffness is slightly higher than without.",
            Verdict.CONTRADICTS if rises < 0.0 else Verdict.NEEDS_AN_ASSUMPTION,
            rises,
            "%",
            f"is the change nearest to a rise at any torque up to {TORQUES[-1]:g} N m",
            "What is taken off a flank can only add to the deflection at a load. The tangent "
            f"stiffness does not rise either (at best {tangent:.3f} %).",
            margin=0.01,
        ),
        Finding(
            "Relief reduces the mesh stiffness.",
            Verdict.of((relieved["change"] < 0.0).all()),
            means.loc[(low, "pinion", AMOUNTS[1])]["change"],
            "%",
            f"of the mean by 10 µm at the pinion's tip, {low:g} N m",
            "The lower the torque, the more.",
        ),
        Finding(
            "Relief reduces the fluctuation of the stiffness.",
            Verdict.of((ripple < 1.0).all()),
            ten["peak_to_peak"],
            "%",
            f"of the mean, peak to peak, with 10 µm at both tips against "
            f"{plain['peak_to_peak']:.2f} % without, {low:g} N m",
            f"In all cases shown, to {ripple.min():.2f} to {ripple.max():.2f} of that without.",
        ),
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """A column for each torque, a row for each place of the relief."""
    from herringbone.plotting.style import COLOURS, legend, new_figure  # noqa: PLC0415 (lazy)

    curves = tables["curves"]
    title = "Mesh stiffness of both halves with parabolic relief over 3 mm"
    figure = new_figure(title, len(TIPS), len(_SHOWN))
    panels = figure.subplots(len(TIPS), len(_SHOWN), sharex=True)
    for row, (tips, where) in zip(panels, TIPS.items(), strict=True):
        for axes, torque in zip(row, _SHOWN, strict=True):
            for colour, amount in zip(COLOURS, (0.0, *AMOUNTS), strict=False):
                one = curves[
                    (curves["tips"] == tips)
                    & (curves["torque"] == torque)
                    & (curves["relief"] == amount)
                ]
                phase, k = two_periods(one["phase"], 1e-9 * one["k"])
                axes.plot(phase, k, color=colour, label=f"{amount:g} µm")
            axes.set_title(f"{torque:g} N m, {where}", fontsize=9.0)
            axes.set_xlim(0.0, 2.0)
        row[0].set_ylabel("k [10⁹ N/m]")
    for axes in panels[-1]:
        axes.set_xlabel("phase [mesh periods]")
    legend(panels[0][-1], 1)
    return {"relief_over_phase": figure}


ENTRY = Entry(
    name="relief_over_phase",
    group="pair",
    title="Stiffness over a mesh period with tip relief",
    source="chapter 2.4, figure 2.5",
    shows="Parabolic relief of 0, 5 and 10 µm over 3 mm: the stiffness is slightly higher with "
    "5 µm and 0.95 % lower with 10 µm. Neither the torque nor which tips are relieved is stated.",
    compute=compute,
    draw=draw,
    seconds=1.0,
)

"""What the stiffness of a pair is whose halves carry different loads: three definitions."""

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.gears.load.table_law import TableLaw
from herringbone.gears.stiffness.load_sharing import LoadSharing, load_sharing
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.pair.finite_elements import by_elements
from herringbone.thesis.pair.holding import MICROMETRES, TORQUES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_AXIAL = np.geomspace(1e5, 1e11, 37)
"""Axial stiffness of the pinion [N/m]; the last is as good as rigid."""
DEFINITIONS = {
    "sum": "k_L + k_R",
    "loaded": "F over the deflection of the loaded half",
    "mean": "F over the mean deflection of both halves",
}
_LIFTS = {"sum": -11.0, "loaded": 4.0, "mean": 4.0}
"""Of the labels of the curves [points]."""
_HIGH, _MOST = TORQUES[-1], MICROMETRES[-1]


def compute() -> Outcome:
    """Changes of the stiffness against no deviation, by each definition."""
    law, rows = TableLaw(by_elements()), []
    for torque in TORQUES:
        even = _by_definition(load_sharing(law, torque, 0.0))
        for deviation in MICROMETRES[1:]:
            for axial in _AXIAL:
                found = load_sharing(law, torque, 1e-6 * deviation, pinion_axial_stiffness=axial)
                now = _by_definition(found)
                change = [100.0 * (now[name] / even[name] - 1.0) for name in DEFINITIONS]
                rows.append((torque, deviation, axial, 100.0 * found.share_left, *change))
    names = ["torque", "deviation", "axial_stiffness", "share_left", *DEFINITIONS]
    units = {"torque": "N.m", "deviation": "um", "axial_stiffness": "N/m"}
    units |= dict.fromkeys(("share_left", *DEFINITIONS), "%")
    found = pd.DataFrame(rows, columns=names)
    return Outcome({"changes": table(found.to_dict("list"), units)}, _findings(found))


def _by_definition(found: LoadSharing) -> dict[str, float]:
    """Stiffness of the pair [N/m]; none by the mean deflection where a half is apart."""
    both = np.minimum(found.deflection_left, found.deflection_right).min() > 0.0
    return {
        "sum": found.stiffness_left + found.stiffness_right,
        "loaded": found.stiffness_by_loaded_half,
        "mean": found.stiffness_by_mean_approach if both else float("nan"),
    }


def _findings(changes: pd.DataFrame) -> tuple[Finding, ...]:
    at = changes[(changes["torque"] == _HIGH) & (changes["deviation"] == _MOST)].iloc[-1]
    case = f"at {_HIGH:g} N m and {_MOST:g} µm, pinion axially rigid"
    return (
        Finding(
            "Higher local deformation of the loaded side reduces the overall stiffness Fₙ/δₙ.",
            Verdict.NEEDS_AN_ASSUMPTION,
            at["loaded"],
            "%",
            f"with δₙ of the loaded half, {case}",
            f"With the mean deflection of both halves it is {at['mean']:+.2f} %: the trend is one "
            "of the definition of δₙ, which the thesis leaves open.",
        ),
        Finding(
            "The stiffness of the pair is the sum of those of its halves.",
            Verdict.NEEDS_AN_ASSUMPTION,
            at["sum"] - at["loaded"],
            "%",
            f"between k_L + k_R ({at['sum']:+.2f} %) and Fₙ/δₙ of the loaded half, {case}",
            "The sum is Fₙ/δₙ only where both halves deflect alike.",
        ),
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Changes over the axial stiffness of the pinion, a column for each torque."""
    from herringbone.plotting.style import COLOURS, legend, new_figure  # noqa: PLC0415 (lazy)

    changes = tables["changes"]
    figure = new_figure("Stiffness of the pair by three definitions", 2, len(TORQUES))
    panels = figure.subplots(2, len(TORQUES), sharex=True)
    for column, torque in zip(panels.T, TORQUES, strict=True):
        for deviation, dash in zip(MICROMETRES[1:], ((0, (4, 2)), "-"), strict=True):
            one = changes[(changes["torque"] == torque) & (changes["deviation"] == deviation)]
            axial = one["axial_stiffness"]
            for colour, (name, told) in zip(COLOURS, DEFINITIONS.items(), strict=False):
                label = told if deviation == _MOST else None
                column[0].semilogx(axial, one[name], color=colour, linestyle=dash, label=label)
                last = one[name].iloc[-1]
                if deviation == _MOST and not np.isnan(last):
                    column[0].annotate(
                        f"{last:+.1f} %", (axial.iloc[-1], last), textcoords="offset points",
                        xytext=(2.0, _LIFTS[name]), fontsize=8.0, color=colour, ha="right",
                    )  # fmt: skip
            column[1].semilogx(
                axial, one["share_left"], color=COLOURS[6], linestyle=dash,
                label=f"{deviation:g} µm",
            )  # fmt: skip
        column[0].set_title(f"{torque:g} N m")
        column[0].margins(y=0.1)
        column[0].set_ylabel("change against no deviation [%]")
        column[1].set(xlabel="axial stiffness of the pinion [N/m]", ylabel="share of the left [%]")
    panels[0][0].legend(loc="lower left")
    legend(panels[1][0], 2)
    return {"definitions": figure}


ENTRY = Entry(
    name="stiffness_definitions",
    group="pair",
    title="Three definitions of the pair's stiffness",
    source="chapters 2.1 and 2.3",
    shows="The stiffness is defined twice, as Fₙ/δₙ and as k_L + k_R, and said to fall with the "
    "symmetry deviation because the loaded side deforms more.",
    compute=compute,
    draw=draw,
    seconds=1.0,
)

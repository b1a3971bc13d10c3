"""Stiffness of both halves over a mesh period, figures 2.1 and 2.2."""

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.gears.load.table_law import TableLaw
from herringbone.gears.stiffness.load_sharing import LoadSharing, load_sharing
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.pair.finite_elements import by_elements
from herringbone.thesis.pair.holding import HOLDINGS, MICROMETRES, TORQUES
from herringbone.thesis.pair.periods import two_periods

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PHASES = 64
_WIDTHS = (3.2, 1.8, 0.9)
"""Of the lines: those that coincide are all seen."""
_KEYS = ("torque", "pinion", "deviation")
_UNITS = {"torque": "N.m", "deviation": "um", "phase": "mesh periods"}
_FLOATING, _HELD, _RIGID = HOLDINGS
_LOW, _HIGH = TORQUES
_MOST = MICROMETRES[-1]
_SEEN = 0.1
"""Change of a stiffness, and of a share, that a printed curve shows [%]."""


def compute() -> Outcome:
    """Equilibrium of both halves at each torque, holding and deviation."""
    law = TableLaw(by_elements())
    rows, means = [], []
    for torque in TORQUES:
        for name, stiffness in HOLDINGS.items():
            for deviation in MICROMETRES:
                found = load_sharing(
                    law,
                    torque,
                    1e-6 * deviation,
                    pinion_axial_stiffness=stiffness,
                    phases=PHASES,
                )
                case = (torque, name, deviation)
                each = zip(found.phases, found.secant_left, found.secant_right, strict=True)
                rows += [(*case, *values) for values in each]
                means.append((*case, *_means(found)))
    curves = pd.DataFrame(rows, columns=[*_KEYS, "phase", "k_left", "k_right"])
    told = pd.DataFrame(
        means, columns=[*_KEYS, "share_left", "k_left", "k_right", "k_both", "range_left",
                        "range_right"],
    )  # fmt: skip
    even = told[told["deviation"] == 0.0].set_index(["torque", "pinion"])["k_both"]
    told["change"] = (
        100.0
        * (
            told["k_both"].to_numpy()
            / even.loc[list(zip(told["torque"], told["pinion"], strict=True))]
            - 1.0
        ).to_numpy()
    )
    stiffness_units = dict.fromkeys(("k_left", "k_right", "k_both", "range_left"), "N/m")
    stiffness_units |= {"range_right": "N/m", "share_left": "%", "change": "%"}
    return Outcome(
        {
            "means": table(told.to_dict("list"), {**_UNITS, **stiffness_units}),
            "curves": table(curves.to_dict("list"), {**_UNITS, **stiffness_units}),
        },
        _findings(told.set_index(list(_KEYS))),
    )


def _means(found: LoadSharing) -> tuple[float, ...]:
    left, right = found.stiffness_left, found.stiffness_right
    ranges = (float(np.ptp(k)) for k in (found.secant_left, found.secant_right))
    return 100.0 * found.share_left, left, right, left + right, *ranges


def _findings(means: pd.DataFrame) -> tuple[Finding, ...]:
    held, floating = means.loc[(_LOW, _HELD, _MOST)], means.loc[(_LOW, _FLOATING, _MOST)]
    rigid = means.loc[(_LOW, _RIGID, _MOST)]
    apart = {d: means.loc[(_LOW, _HELD, d)] for d in MICROMETRES}
    ahead = {d: 100.0 * (m["k_left"] / m["k_right"] - 1.0) for d, m in apart.items()}
    alike = 100.0 * (floating["k_left"] / floating["k_right"] - 1.0)
    case = f"at {_LOW:g} N m, {_MOST:g} µm, pinion {_HELD}"
    return (
        Finding(
            "The mesh stiffness of the pair falls as the symmetry deviation grows.",
            Verdict.needing(floating["change"] < -_SEEN, held["change"] < -_SEEN),
            held["change"],
            "%",
            f"k_L + k_R against none, {case}",
            "The pinion must be held axially, which the thesis' own model does not: floating it is "
            f"{abs(floating['change']):.2f} %. Rigid it is {rigid['change']:+.0f} %, because the "
            "right half does not touch.",
            margin=1e-3,
        ),
        Finding(
            "One side carries more load, the other is less engaged.",
            Verdict.needing(*(c["share_left"] > 50.0 + _SEEN for c in (floating, held))),
            held["share_left"],
            "%",
            f"of the load on the left half, {case}",
            f"A floating pinion moves axially until both halves carry the same: "
            f"{floating['share_left']:.2f} %. A constant deviation loads nothing then.",
        ),
        Finding(
            "The more heavily loaded side has the larger stiffness.",
            Verdict.needing(alike > _SEEN, ahead[_MOST] > _SEEN),
            ahead[_MOST],
            "%",
            f"k_L over k_R, {case}",
            "Contacts stiffen under load (Hertz). Of a floating pinion no side carries more: "
            f"{abs(alike):.2f} %.",
        ),
        Finding(
            "The stiffnesses of both sides become increasingly different.",
            Verdict.of(ahead[_MOST] > ahead[10.0] > ahead[0.0], assuming=alike < _SEEN),
            ahead[_MOST] - ahead[10.0],
            "%",
            f"more difference at {_MOST:g} than at 10 µm ({ahead[10.0]:.1f} %), pinion {_HELD}",
            "Where the pinion is held; floating, they stay alike.",
        ),
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """A figure for each torque: left and right half beside each other, as in the thesis."""
    return {f"{torque:g} N m": _figure(tables["curves"], torque) for torque in TORQUES}


def _figure(curves: pd.DataFrame, torque: float) -> "Figure":
    from herringbone.plotting.style import COLOURS, legend, new_figure  # noqa: PLC0415 (lazy)

    title = f"Mesh stiffness of the halves over two mesh periods, {torque:g} N m at the pinion"
    figure = new_figure(title, len(HOLDINGS), 2)
    panels = figure.subplots(len(HOLDINGS), 2, sharex=True, sharey=True)
    at = curves[curves["torque"] == torque]
    touching = at[["k_left", "k_right"]].to_numpy()
    touching = 1e-9 * touching[touching > 0.0]
    limits = touching.min() - 0.02, touching.max() + 0.02
    for row, name in zip(panels, HOLDINGS, strict=True):
        for axes, side in zip(row, ("left", "right"), strict=True):
            for colour, width, deviation in zip(COLOURS, _WIDTHS, MICROMETRES, strict=False):
                one = at[(at["pinion"] == name) & (at["deviation"] == deviation)]
                phase, values = two_periods(one["phase"], 1e-9 * one[f"k_{side}"])
                label = f"{deviation:g} µm"
                axes.plot(phase, values, color=colour, linewidth=width, label=label)
            axes.set_title(f"{side} half, pinion {name}")
            axes.set_xlim(0.0, 2.0)
            axes.set_ylim(*limits)
            if (apart := at[(at["pinion"] == name) & (at[f"k_{side}"] == 0.0)]).size:
                told = " and ".join(f"{d:g}" for d in sorted(apart["deviation"].unique()))
                axes.text(1.0, limits[0], f"{told} µm: apart, k = 0", ha="center", va="bottom")
        row[0].set_ylabel("k [10⁹ N/m]")
    for axes in panels[-1]:
        axes.set_xlabel("phase [mesh periods]")
    legend(panels[0][1], 3)
    return figure


ENTRY = Entry(
    name="mesh_stiffness_over_a_period",
    group="pair",
    title="Stiffness of both halves over a mesh period",
    source="chapter 2.3, figures 2.1 and 2.2",
    shows="k_L and k_R over time for symmetry deviations of 0, 10 and 20 µm, from finite elements "
    "with contact. The torque is not stated, nor how the gears were held axially. The stiffness is "
    "said to fall with the deviation, and the more loaded side to be the stiffer one.",
    compute=compute,
    draw=draw,
    seconds=1.0,
)

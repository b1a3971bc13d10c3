"""Static transmission error with relief, over torque."""

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.gears import MeshStiffness
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.pair.finite_elements import TORQUES, by_elements
from herringbone.thesis.pair.periods import two_periods
from herringbone.thesis.pair.relief.readings import AMOUNTS, TIPS, relief

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_TORQUE = 200.0
_HIGHEST = 5000.0


def compute() -> Outcome:
    """Peak to peak over torque, and curves at one torque."""
    rows, curves = [], []
    for tips in TIPS:
        for amount in (0.0, *AMOUNTS):
            found = by_elements() if amount == 0.0 else relief(tips, amount)
            each = zip(TORQUES, _peak_to_peak(found), strict=True)
            rows += [(tips, amount, torque, error) for torque, error in each]
            error = 1e6 * found.transmission_error[TORQUES.index(_TORQUE) + 1]
            about = zip(found.phases, error - error.mean(), strict=True)
            curves += [(tips, amount, *values) for values in about]
    units = {"relief": "um", "torque": "N.m", "peak_to_peak": "um", "phase": "mesh periods"}
    over_torque = pd.DataFrame(rows, columns=["tips", "relief", "torque", "peak_to_peak"])
    over_phase = pd.DataFrame(curves, columns=["tips", "relief", "phase", "error"])
    return Outcome(
        {
            "over_torque": table(over_torque.to_dict("list"), units),
            "curves": table(over_phase.to_dict("list"), {**units, "error": "um"}),
        },
        _findings(over_torque.set_index(["tips", "relief", "torque"])["peak_to_peak"]),
    )


def _peak_to_peak(found: MeshStiffness) -> np.ndarray:
    """Of the transmission error at `TORQUES` [um]."""
    return 1e6 * np.ptp(found.transmission_error[1:], axis=1)


def _findings(error: pd.Series) -> tuple[Finding, ...]:
    pinion, both = (_change(error, tips, _TORQUE) for tips in TIPS)
    low = _change(error, "both", TORQUES[0])
    return (
        Finding(
            "Relief potentially alleviates the dynamic excitation.",
            Verdict.of(both < 0.0),
            both,
            "%",
            f"of the transmission error, peak to peak, by 10 µm at both tips, {_TORQUE:g} N m",
            f"At the pinion's tip alone {pinion:+.1f} %; at {TORQUES[0]:g} N m, far from the load "
            f"that suits it, both tips give {low:+.0f} %.",
        ),
    )


def _change(error: pd.Series, tips: str, torque: float) -> float:
    """Of the peak to peak by 10 um [%]."""
    return 100.0 * (error[(tips, AMOUNTS[1], torque)] / error[(tips, 0.0, torque)] - 1.0)


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Curves at a torque, and peak to peak over torque."""
    from herringbone.plotting.style import COLOURS, new_figure  # noqa: PLC0415 (lazy)

    curves, over_torque = tables["curves"], tables["over_torque"]
    figure = new_figure("Static transmission error with relief", 1, 2)
    left, right = figure.subplots(1, 2)
    for tips, dash in zip(TIPS, ((0, (4, 2)), "-"), strict=True):
        for colour, amount in zip(COLOURS, (0.0, *AMOUNTS), strict=False):
            if amount == 0.0 and tips != "both":
                continue  # the same twice
            one = curves[(curves["tips"] == tips) & (curves["relief"] == amount)]
            label = f"{amount:g} µm {TIPS[tips]}" if amount else "none"
            phase, error = two_periods(one["phase"], one["error"])
            left.plot(phase, error, color=colour, linestyle=dash)
            of = (over_torque["tips"] == tips) & (over_torque["relief"] == amount)
            shown = over_torque[of & (over_torque["torque"] <= _HIGHEST)]
            right.loglog(
                shown["torque"], shown["peak_to_peak"], color=colour, linestyle=dash, label=label
            )
    left.set(
        title=f"About its mean, {_TORQUE:g} N m", xlabel="phase [mesh periods]",
        ylabel="on the line of action [µm]", xlim=(0.0, 2.0),
    )  # fmt: skip
    right.set(title="Peak to peak", xlabel="torque of the pinion [N m]", ylabel="[µm]")
    right.legend(loc="upper left")
    return {"transmission_error": figure}


ENTRY = Entry(
    name="relief_transmission_error",
    group="pair",
    title="Transmission error with relief",
    source="chapters 2.4 and 6",
    shows="Relief is said to reduce the stiffness and with it, potentially, the dynamic "
    "excitation; no excitation is shown.",
    compute=compute,
    draw=draw,
    seconds=1.0,
)

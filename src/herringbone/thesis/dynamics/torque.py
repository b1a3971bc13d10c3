"""Vibration over the load torque."""

from typing import TYPE_CHECKING

import pandas as pd

from herringbone.thesis import names
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.ground import (
    SIGNALS,
    TORQUES,
    levels,
    settled,
    unit,
    window,
    window_levels,
)
from herringbone.thesis.panels import level_panels
from herringbone.thesis.trends import growth, rises

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_TORQUES = (100.0, 150.0, *TORQUES, 350.0, 400.0)
_STAGGER = 0.25
_SETTLED, _APART, _WINDOW = "settled", "settled, halves a quarter period apart", "window"
_AXIAL, _RADIAL = "pinion axial velocity", "pinion radial velocity"
_SHOWN = [name for name in SIGNALS if "velocity" in name]


def compute() -> Outcome:
    """Levels at the thesis' and at more torques."""
    rows: list[dict[str, float | str]] = []
    for torque in _TORQUES:
        for seen, stagger in ((_SETTLED, 0.0), (_APART, _STAGGER)):
            (state,) = settled(torque=torque, values={f"{names.GEAR}.stagger": stagger})
            rows.append({"seen": seen, "torque": torque, **levels(state)})
        rows.append({"seen": _WINDOW, "torque": torque, **window_levels(window(torque=torque))})
    found = pd.DataFrame(rows).sort_values("seen", kind="stable", ignore_index=True)
    return Outcome(
        {"levels": table(found, {"torque": "N m"} | {name: unit(name) for name in SIGNALS})},
        _findings(found),
    )


def _findings(found: pd.DataFrame) -> tuple[Finding, ...]:
    by = {
        seen: rows[rows["torque"].isin(TORQUES)].reset_index(drop=True)
        for seen, rows in found.groupby("seen")
    }
    change = {seen: growth(rows[_AXIAL].to_numpy()) for seen, rows in by.items()}
    sentence = "From 200 to 300 N m the axial velocity grows noticeably"
    wheel = growth(by[_SETTLED]["wheel axial velocity"].to_numpy())
    return (
        Finding(
            f"{sentence}: settled.",
            Verdict.of(rises(by[_SETTLED][_AXIAL])),
            change[_SETTLED],
            "%",
            f"change of the pinion's; of the wheel's {wheel:+.0f} %",
            "The pinion follows the run-out of the apex, whatever the load. The halves' mesh "
            "forces, which grow with it, cancel axially.",
            margin=0.02,
        ),
        Finding(
            f"{sentence}: if the halves mesh a quarter period apart.",
            Verdict.of(rises(by[_APART][_AXIAL]), assuming=True),
            change[_APART],
            "%",
            "change of the pinion's",
            "Stagger, or any other difference between left and right, must be assumed: the thesis "
            "has none but f_A.",
            margin=0.3,
        ),
        Finding(
            f"{sentence}: in the window of the thesis.",
            Verdict.of(rises(by[_WINDOW][_AXIAL])),
            change[_WINDOW],
            "%",
            f"change of the pinion's; {growth(by[_WINDOW][_AXIAL].to_numpy()[:2]):+.0f} % from 200 "
            "to 250 N m",
            "The decay of the start hides the operating point.",
            margin=1.0,
        ),
        Finding(
            "Radial vibration grows with torque.",
            Verdict.of(rises(by[_SETTLED][_RADIAL])),
            growth(by[_SETTLED][_RADIAL].to_numpy()),
            "%",
            "change of the pinion's radial velocity from 200 to 300 N m, settled",
            "Parametric excitation goes with the load.",
            margin=0.1,
        ),
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Velocities over torque."""
    title = "1000 r/min, f_A 10 µm: velocities over torque, settled and in the thesis' window"
    return {"torque": level_panels(title, tables["levels"], "torque", _SHOWN,
                                   "torque at the pinion [N m]", "seen")}  # fmt: skip


ENTRY = Entry(
    name="load_torque",
    group="dynamics",
    title="Influence of the load torque",
    source="chapter 3.5",
    shows="Axial velocity of the pinion at 200, 250 and 300 N m and constant speed, said to grow "
    "noticeably with torque.",
    compute=compute,
    draw=draw,
    seconds=5.0,
)

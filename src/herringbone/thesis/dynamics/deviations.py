"""Displacements and velocities at three symmetry deviations, figures 3.5 to 3.20."""

from typing import TYPE_CHECKING

import pandas as pd

from herringbone.scenes import Start
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.ground import (
    DEVIATIONS,
    MICRO,
    SIGNALS,
    levels,
    piece,
    settled,
    unit,
    window,
    window_levels,
)
from herringbone.thesis.panels import signal_panels
from herringbone.thesis.trends import growth, rises

if TYPE_CHECKING:
    from matplotlib.figure import Figure

WINDOW, UNLOADED, SETTLED = "window of the thesis", "window, from unloaded rest", "settled"
"""How the model was looked at: from bodies at their places, or from equilibrium without load."""
_UNITS = {name: unit(name) for name in SIGNALS}


def compute() -> Outcome:
    """Signals of both windows, and levels."""
    tables, rows = {}, []
    for deviation in DEVIATIONS:
        told = f"{MICRO * deviation:.0f} µm"
        first = window(deviation=deviation)
        (state,) = settled(deviation=deviation)
        unloaded = window(deviation=deviation, start=Start.RAMP)
        for how, found in (
            (WINDOW, window_levels(first)),
            (UNLOADED, window_levels(unloaded)),
            (SETTLED, levels(state)),
        ):
            rows.append({"f_A": MICRO * deviation, "seen": how, **found})
        for how, shown in ((WINDOW, first), (SETTLED, piece(state))):
            tables[f"{how}, f_A {told}"] = table(shown, {"time": "s", **_UNITS})
    found = table(pd.DataFrame(rows), {"f_A": "µm", **_UNITS})
    return Outcome({"levels": found, **tables}, _findings(found))


def _findings(found: pd.DataFrame) -> tuple[Finding, ...]:
    by = {how: rows.reset_index(drop=True) for how, rows in found.groupby("seen")}
    axial, wheel = (
        by[SETTLED][f"{gear} axial velocity"].to_numpy() for gear in ("pinion", "wheel")
    )
    return (
        Finding(
            "Axial vibration of the pinion grows with the symmetry deviation.",
            Verdict.of(rises(axial)),
            axial[2] / axial[1],
            "",
            "times the axial velocity of the pinion at 20 µm against 10 µm, settled",
            "It is the part of f_A that turns with the pinion; the constant part does not vibrate.",
        ),
        Finding(
            "Axial vibration of the wheel grows with the symmetry deviation.",
            Verdict.of(rises(wheel)),
            growth(wheel[:2]),
            "%",
            f"change of the axial velocity of the wheel from 0 to 10 µm, {growth(wheel):+.0f} % to "
            f"20 µm, settled ({wheel[0]:.1e} mm/s at 0 µm)",
            "A floating pinion gives way: hardly any of f_A comes to the wheel.",
            margin=1.0,
        ),
        *_radial(by),
        *_gears(by),
    )


def _radial(by: dict[str, pd.DataFrame]) -> tuple[Finding, ...]:
    """Of the trend of the radial vibration."""
    signal = "pinion radial velocity"
    change = {how: growth(by[how][signal].to_numpy()) for how in by}
    sentence = "Radial vibration grows with the symmetry deviation as the axial one does"
    return (
        Finding(
            f"{sentence}: once the start has died out.",
            Verdict.of(rises(by[SETTLED][signal])),
            change[SETTLED],
            "%",
            "change of the radial velocity of the pinion from 0 to 20 µm",
            "Radial vibration comes from the mesh stiffness, which f_A hardly changes.",
            margin=0.02,
        ),
        Finding(
            f"{sentence}: in the window of the thesis.",
            Verdict.of(rises(by[WINDOW][signal]), assuming=True),
            change[WINDOW],
            "%",
            f"change from 0 to 20 µm; {change[UNLOADED]:+.0f} % if the run starts from equilibrium "
            "without load",
            "The window must hold the start's decay: bodies begin at their places, where f_A "
            "already presses one side together.",
            margin=1.0,
        ),
    )


def _gears(by: dict[str, pd.DataFrame]) -> tuple[Finding, ...]:
    """Of pinion against wheel: the smallest ratio of all directions, quantities, deviations."""
    found = []
    for how in (SETTLED, WINDOW):
        rows = by[how]
        ratios = {
            name.removeprefix("pinion "): float((rows[name] / rows[f"wheel{name[6:]}"]).min())
            for name in SIGNALS
            if name.startswith("pinion")
        }
        least = min(ratios, key=lambda name: ratios[name])
        found.append(
            Finding(
                "The pinion vibrates more than the wheel in both directions"
                + (": settled." if how == SETTLED else ": in the window of the thesis."),
                Verdict.of(ratios[least] > 1.0),
                ratios[least],
                "",
                f"times as much as the wheel, at least ({least})",
                "At 1000 r/min; see the entry on speed for where it fails.",
                margin=0.02,
            )
        )
    return tuple(found)


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Three curves a panel, in the window and settled."""
    figures = {}
    for name, how in (("window", WINDOW), ("settled", SETTLED)):
        rows = {
            key.removeprefix(f"{how}, "): found
            for key, found in tables.items()
            if key.startswith(f"{how}, f_A")
        }
        title = "1000 r/min, 200 N m, " + (
            "0.02 to 0.04 s after the start" if how == WINDOW else "settled"
        )
        figures[name] = signal_panels(title, rows, list(SIGNALS), list(_UNITS.values()))
    return figures


ENTRY = Entry(
    name="symmetry_deviation",
    group="dynamics",
    title="Displacements and velocities of both gears at three symmetry deviations",
    source="chapter 3.4, figures 3.5 to 3.20",
    shows="Axial and radial displacement and velocity of pinion and wheel at f_A 0, 10 and 20 µm, "
    "0.02 to 0.04 s after the start; all are said to grow with f_A, most at the pinion.",
    compute=compute,
    draw=draw,
    seconds=4.0,
)

"""Motions of both bearing seats: the thesis' procedure beside settled states."""

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.ground import DEVIATION, DEVIATIONS, settled, unit, window_levels
from herringbone.thesis.housing.response import (
    ACROSS,
    FOUR_MODES,
    SEATS,
    seat_levels,
    seat_piece,
    thesis_procedure,
)
from herringbone.thesis.panels import signal_panels
from herringbone.thesis.trends import growth, rises

if TYPE_CHECKING:
    from matplotlib.figure import Figure

THESIS = "procedure of the thesis"
"""One way, four modes, 0.02 to 0.04 s after the start."""
_FOUR, _ALL, _BOTH = "settled, one way, four modes", "settled, one way", "settled, two-way"
_ALIKE = 0.1
"""Difference of levels that counts as none."""
_UNITS = {name: unit(name) for name in (*SEATS, *ACROSS)}


def compute() -> Outcome:
    """Motions over time at f_A 10 um, rms at all f_A."""
    rows, tables = [], {}
    for deviation in DEVIATIONS:
        _, shown = thesis_procedure(deviation)
        own = {THESIS: window_levels(shown)}
        pieces = {THESIS: shown}
        for how, moving, values in ((_FOUR, False, FOUR_MODES), (_ALL, False, None),
                                    (_BOTH, True, None)):  # fmt: skip
            (state,) = settled(deviation=deviation, seats_move=moving, values=values)
            own[how], pieces[how] = seat_levels(state), seat_piece(state)
        rows += [{"how": how, "f_A": 1e6 * deviation, **found} for how, found in own.items()]
        if deviation == DEVIATION:
            tables = {how: table(p, {"time": "s", **_UNITS}) for how, p in pieces.items()}
    found = table(pd.DataFrame(rows), {"f_A": "µm", **_UNITS})
    return Outcome({"levels": found, **tables}, _findings(found))


def _findings(found: pd.DataFrame) -> tuple[Finding, ...]:
    at = found[found["f_A"] == 1e6 * DEVIATION].set_index("how")
    return (*_active(at), *_radial(at), *_deviation(found), _steady(at))


def _steady(at: pd.DataFrame) -> Finding:
    """Of the window against the same model when it has settled."""
    signal = "pinion seat radial velocity"
    ratio = float(at[signal][THESIS] / at[signal][_FOUR])
    return Finding(
        "Figures 4.9 to 4.16 show the steady response.",
        Verdict.of(abs(ratio - 1.0) < _ALIKE),
        ratio,
        "",
        f"times its settled level has the {signal} in the window ({at[signal][THESIS]:.2f} against "
        f"{at[signal][_FOUR]:.2f} mm/s, both with four modes)",
        "Levels of millimetres per second, which the sensors' range of 50 mm/s asks for, come from "
        "the start; perfect teeth settle far below.",
        margin=0.3,
    )


def _active(at: pd.DataFrame) -> tuple[Finding, ...]:
    """Of the active shaft's seat against the other one's: the least ratio of all motions."""
    pairs = [(name, name.replace("pinion", "wheel")) for name in SEATS if name.startswith("pinion")]
    found = []
    for how, rows in at.iterrows():
        ratios = {one.removeprefix("pinion "): rows[one] / rows[other] for one, other in pairs}
        least = min(ratios, key=lambda name: ratios[name])
        found.append(
            Finding(
                f"The active shaft's seat vibrates more than the driven one's: {how}.",
                Verdict.of(ratios[least] > 1.0),
                float(ratios[least]),
                "",
                f"times as much, at least ({least})",
                margin=0.05,
            )
        )
    return tuple(found)


def _radial(at: pd.DataFrame) -> tuple[Finding, ...]:
    """Of radial against axial velocity, the lesser of both seats; radial is read in two ways."""
    found = []
    for how, rows in at.iterrows():
        along, both = {}, {}
        for gear in ("pinion", "wheel"):
            radial, across, axial = (
                float(rows[f"{gear} seat {what}"])
                for what in ("radial velocity", "velocity across", "axial velocity")
            )
            along[gear], both[gear] = radial / axial, np.hypot(radial, across) / axial
        least = min(along, key=lambda gear: along[gear])
        found.append(
            Finding(
                f"Radial vibration of the seats is larger than axial: {how}.",
                Verdict.needing(along[least] > 1.0, min(both.values()) > 1.0),
                along[least],
                "",
                f"times the axial velocity at the {least}, at least",
                "Radial is along the line of action here; with both directions across the shafts "
                f"it is {min(both.values()):.2f}.",
                margin=0.05,
            )
        )
    return tuple(found)


def _deviation(found: pd.DataFrame) -> tuple[Finding, ...]:
    """Of what f_A adds to the axial vibration of the seats."""
    signal, change = "pinion seat axial velocity", {}
    for how, rows in found.groupby("how"):
        change[how] = growth(rows[signal].to_numpy())
    return tuple(
        Finding(
            f"Axial vibration of the housing is excited by the symmetry deviation: {how}.",
            Verdict.of(rises(found[found["how"] == how][signal])),
            change[how],
            "%",
            "change of the axial velocity at the pinion's seat from f_A 0 to 20 µm",
            "A floating pinion follows a slow run-out without force."
            if how != THESIS
            else "It is the decay of the start, which f_A excites.",
            margin=0.2 if how != THESIS else 20.0,
        )
        for how in (THESIS, _BOTH)
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """The layout of figures 4.9 to 4.16: both seats, radial and axial."""
    units = [unit(name) for name in SEATS]
    both = {name: tables[name] for name in (_BOTH, _ALL)}
    thesis = {THESIS: tables[THESIS]}
    what = "Seats of the left bearings, 1000 r/min, 200 N m, f_A 10 µm, "
    return {
        "thesis": signal_panels(what + "as in the thesis: one way, four modes, 20 to 40 ms",
                                thesis, list(SEATS), units),
        "settled": signal_panels(what + "settled", both, list(SEATS), units),
    }  # fmt: skip


ENTRY = Entry(
    name="seat_response",
    group="housing",
    title="Response of both bearing seats",
    source="chapter 4.3, figures 4.9 to 4.16",
    shows="Radial and axial displacement and velocity of a seat of each shaft by superposition of "
    "four modes, driven by the bearing forces of a model on rigid ground.",
    compute=compute,
    draw=draw,
    seconds=6.0,
)

"""Bearing forces at the thesis' operating point."""

from typing import TYPE_CHECKING

import pandas as pd

from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.ground import DEVIATION, levels, piece, settled, window_levels
from herringbone.thesis.housing.response import FORCES, thesis_procedure
from herringbone.thesis.panels import signal_panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WINDOW, _GROUND, _HOUSING = "window of the thesis", "settled, rigid ground", "settled, two-way"
_UNITS = dict.fromkeys(FORCES, "N")
_RADIAL, _AXIAL = "radial", "axial"


def compute() -> Outcome:
    """Forces over time, rms and mean."""
    shown, _ = thesis_procedure(DEVIATION)
    tables = {_WINDOW: shown}
    rows = [{"seen": _WINDOW, **window_levels(shown)}]
    means = [{"seen": _WINDOW, **{name: float(shown[name].mean()) for name in FORCES}}]
    for seen, moving in ((_GROUND, False), (_HOUSING, True)):
        (state,) = settled(seats_move=moving)
        tables[seen] = piece(state, FORCES)
        rows.append({"seen": seen, **levels(state, FORCES)})
        means.append({"seen": seen, **{name: state.mean(c) for name, c in FORCES.items()}})
    found = {name: table(rows_, {"time": "s", **_UNITS}) for name, rows_ in tables.items()}
    found = {"levels": table(pd.DataFrame(rows), _UNITS),
             "means": table(pd.DataFrame(means), _UNITS), **found}  # fmt: skip
    return Outcome(found, _findings(pd.DataFrame(rows).set_index("seen"),
                                    pd.DataFrame(means).set_index("seen")))  # fmt: skip


def _findings(rms: pd.DataFrame, means: pd.DataFrame) -> tuple[Finding, ...]:
    ratio = rms["pinion radial force"] / rms["wheel radial force"]
    static = float(means["pinion radial force"][_GROUND] / -means["wheel radial force"][_GROUND])
    wheel = rms["wheel axial force"]
    sentence = "Forces on the active shaft are larger than on the driven one"
    return (
        *(
            Finding(
                f"{sentence}: radial, alternating, {seen}.",
                Verdict.of(own > 1.0),
                float(own),
                "",
                "times that at the wheel",
                margin=0.02,
            )
            for seen, own in ratio.items()
        ),
        Finding(
            f"{sentence}: radial, mean.",
            Verdict.of(static > 1.01),
            static,
            "",
            "times that at the wheel: both carry the force of the line of action",
        ),
        Finding(
            f"{sentence}: axial.",
            Verdict.of((rms["pinion axial force"] > wheel).all()),
            float(rms["pinion axial force"].max()),
            "N",
            f"at the pinion, {wheel[_WINDOW]:.0f} N at the wheel in the window, "
            f"{wheel[_GROUND]:.2f} N settled",
            "The thesis' pinion floats axially (chapter 6, table 3.1): it has no axial bearing.",
        ),
        Finding(
            "Reaction forces are periodic with the meshing of the teeth, from 0.02 to 0.04 s.",
            Verdict.of(float(rms["wheel axial force"][_WINDOW] / wheel[_GROUND]) < 1.1),
            float(rms["wheel radial force"][_WINDOW] / rms["wheel radial force"][_GROUND]),
            "",
            "times the settled level has the wheel's radial force in that window",
            "The start rings at natural frequencies, see the entry on the start.",
            margin=0.2,
        ),
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Forces over time, as the thesis looked at them and settled."""
    rows = {name: tables[name] for name in (_WINDOW, _HOUSING, _GROUND)}
    title = "Bearing forces of the left halves, 1000 r/min, 200 N m, f_A 10 µm, means taken out"
    return {"forces": signal_panels(title, rows, list(FORCES), ["N"] * len(FORCES))}


ENTRY = Entry(
    name="bearing_forces",
    group="housing",
    title="Bearing forces",
    source="chapter 4.3",
    shows="Radial and axial reaction forces of both shafts at 1000 r/min and 200 N m over 0.02 to "
    "0.04 s: periodic, and larger at the active shaft.",
    compute=compute,
    draw=draw,
    seconds=2.0,
)

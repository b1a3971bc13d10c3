"""Natural frequencies of the twelve degrees of freedom, corrected and as printed."""

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.thesis.dynamics.equations import (
    COORDINATES,
    PUBLISHED_STIFFNESS,
    Bodies,
    corrected,
    frequencies,
    mass_matrix,
    printed,
)
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.ground import natural

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LOADED = "at the operating point"
"""1000 r/min and 200 N m, of the shipped scene."""
_TOLD = 3
"""Coordinates by which a mode is told."""


def compute() -> Outcome:
    """Frequencies and shapes."""
    bodies = Bodies()
    mass = mass_matrix(bodies)
    right, shares = frequencies(corrected(bodies, PUBLISHED_STIFFNESS), mass)
    as_printed, _ = frequencies(printed(bodies, PUBLISHED_STIFFNESS), mass)
    loaded = natural()
    rigid = right.size - loaded.frequency_hz.size
    at_point = np.concatenate([np.zeros(rigid), loaded.frequency_hz])
    damping = np.concatenate([np.full(rigid, np.nan), loaded.damping_ratio])
    listed = table(
        {
            "mode": np.arange(1, right.size + 1), "corrected": right, "printed": as_printed,
            _LOADED: at_point, "damping ratio": damping,
            "moves most": [_told(shares[:, k]) for k in range(right.size)],
        },
        {"corrected": "Hz", "printed": "Hz", _LOADED: "Hz"},
    )  # fmt: skip
    shapes = table({"coordinate": COORDINATES}
                   | {f"mode {k + 1}": shares[:, k] for k in range(right.size)})  # fmt: skip
    return Outcome({"frequencies": listed, "kinetic energy": shapes}, _findings(listed))


def _told(shares: np.ndarray) -> str:
    most = np.argsort(shares)[::-1][:_TOLD]
    return ", ".join(f"{COORDINATES[k]} {100.0 * shares[k]:.0f} %" for k in most)


def _findings(listed: pd.DataFrame) -> tuple[Finding, ...]:
    rigid = {name: int((listed[name] == 0.0).sum()) for name in ("corrected", "printed")}
    axial, loaded = (float(listed[name][3]) for name in ("corrected", _LOADED))
    return (
        Finding(
            "The model has twelve degrees of freedom that an elastic shaft segment joins.",
            Verdict.of(rigid["printed"] == 1),
            rigid["printed"],
            "",
            f"rigid rotations of the equations as printed, and each frequency twice: two models of "
            f"six; corrected: {rigid['corrected']} rigid rotation",
            "No printed equation has a stiffness between left and right halves.",
        ),
        Finding(
            "The twelve-degree-of-freedom model gives the vibration of the transmission.",
            Verdict.CANNOT_BE_TESTED,
            float(listed["corrected"][1]),
            "Hz",
            "is its lowest frequency, of the wheel on its axial bearing, at the published mesh "
            "stiffness",
            "The thesis publishes no natural frequency of it, and neither masses nor gap shafts.",
        ),
        Finding(
            "One value of the mean mesh stiffness describes the pair.",
            Verdict.NEEDS_AN_ASSUMPTION,
            loaded,
            "Hz",
            f"is the pinion's axial mode at 200 N m; {axial:.0f} Hz at the published stiffness",
            "Contact softens at low load; the thesis states no torque with its stiffness (see the "
            "entries on stiffness).",
        ),
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Who moves in which mode."""
    from herringbone.plotting.style import new_figure  # noqa: PLC0415 (matplotlib: lazy)

    listed, shapes = tables["frequencies"], tables["kinetic energy"]
    shares = shapes.drop(columns="coordinate").to_numpy()
    figure = new_figure("Twelve degrees of freedom: shares of the kinetic energy", 2, width=11.0)
    figure.subplots_adjust(left=0.12, bottom=0.2)
    axes = figure.subplots()
    axes.imshow(shares, cmap="Blues", vmin=0.0, vmax=1.0, aspect="auto")
    for (row, column), share in np.ndenumerate(shares):
        if share >= 0.005:
            axes.text(column, row, f"{100.0 * share:.0f}", ha="center", va="center", fontsize=7.5,
                      color="white" if share > 0.55 else "black")  # fmt: skip
    told = [
        f"{k}\n{right:.0f}\n{as_printed:.0f}"
        for k, right, as_printed in zip(
            listed["mode"], listed["corrected"], listed["printed"], strict=True
        )
    ]
    axes.set_xticks(range(len(listed)), told)
    axes.set_yticks(range(len(shapes)), shapes["coordinate"])
    axes.set_xlabel("mode; Hz, corrected equations (whose shares these are, %); Hz, as printed")
    axes.grid(visible=False)
    return {"shapes": figure}


ENTRY = Entry(
    name="natural_frequencies",
    group="dynamics",
    title="Natural frequencies of the twelve degrees of freedom",
    source="chapters 3.1 and 3.2, figure 3.1",
    shows="Equations of motion of four gear bodies; no natural frequency.",
    compute=compute,
    draw=draw,
    seconds=1.0,
)

"""Bearing forces with relief over speed: periodic steady states of the gearbox."""

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.analysis.steady.operating_point import Point
from herringbone.running.operating.steady import prepared_solver
from herringbone.running.prepared import Wishes
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.names import GEARBOX, SYMMETRY_DEVIATION
from herringbone.thesis.pair.finite_elements import modification
from herringbone.thesis.pair.given import JOB
from herringbone.thesis.pair.relief.readings import AMOUNTS, TIPS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_TORQUE = 200.0
_SPEEDS = tuple(range(600, 2001, 10))
"""Of the pinion [r/min]; the thesis has three to four of them."""
_SHOWN = 1000
_RANGE = (800, 1500)


def compute() -> Outcome:
    """Level of the bearing forces over speed, with tables of coupled slices."""
    rows = []
    for tips in TIPS:
        for amount in (0.0, *AMOUNTS):
            name = f"{tips} {amount:g}" if amount else "none"
            rows += [(tips, amount, n, level) for n, level in _levels(name)]
    found = pd.DataFrame(rows, columns=["tips", "relief", "speed", "level"])
    units = {"relief": "um", "speed": "r/min", "level": "N"}
    return Outcome({"levels": table(found.to_dict("list"), units)}, _findings(found))


def _levels(relief: str) -> list[tuple[int, float]]:
    """RMS of the alternating bearing forces [N] over speed."""
    job = replace(JOB, modification=modification(relief), method="coupled-slices")
    first = Point(speed=_SPEEDS[0] * math.pi / 30.0, torque=_TORQUE)
    solver, _ = prepared_solver(
        GEARBOX, point=first, wishes=Wishes(gear=job, values={SYMMETRY_DEVIATION: 0.0})
    )
    near, found = None, []
    for n in _SPEEDS:
        near = solver.solve(Point(speed=n * math.pi / 30.0, torque=_TORQUE), near)
        found.append((n, near.level("bearing_force") if near.converged else math.nan))
    return found


def _findings(levels: pd.DataFrame) -> tuple[Finding, ...]:
    within = levels[levels["speed"].between(*_RANGE)]
    curves = within.pivot_table(index="speed", columns=["tips", "relief"], values="level")
    plain, ten = curves[("both", 0.0)], curves[("both", AMOUNTS[1])]
    change = 100.0 * (ten / plain - 1.0)
    lower = 100.0 * float(np.mean(change < 0.0))
    pinion = 100.0 * (curves[("pinion", AMOUNTS[1])] / plain - 1.0)
    mean = 100.0 * (math.sqrt((ten**2).mean() / (plain**2).mean()) - 1.0)
    return (
        Finding(
            "Relief helps to stabilize the dynamic response.",
            _verdict(lower),
            lower,
            "%",
            f"of the speeds from {_RANGE[0]} to {_RANGE[1]} r/min have lower bearing forces with "
            f"10 µm at both tips, {_TORQUE:g} N m",
            f"At {_SHOWN} r/min {change[_SHOWN]:+.0f} %, rms over all these speeds {mean:+.1f} %. "
            f"At the pinion's tip alone {pinion.min():+.0f} to {pinion.max():+.0f} % by the speed. "
            "Relief is made for a load, and other mesh harmonics may meet a resonance.",
            margin=6.0,
        ),
    )


def _verdict(lower: float) -> Verdict:
    """By the share of speeds at which relief helps [%]."""
    if lower > 90.0:
        return Verdict.AGREES
    return Verdict.CONTRADICTS if lower < 10.0 else Verdict.NEEDS_AN_ASSUMPTION


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Levels over speed, a panel for each place of the relief."""
    from herringbone.plotting.style import COLOURS, MARKER_COLOUR, new_figure  # noqa: PLC0415

    levels = tables["levels"]
    title = f"Bearing forces over speed with relief, {_TORQUE:g} N m, perfect teeth, no deviation"
    figure = new_figure(title, 1, 2)
    for axes, (tips, where) in zip(figure.subplots(1, 2, sharey=True), TIPS.items(), strict=True):
        for colour, amount in zip(COLOURS, (0.0, *AMOUNTS), strict=False):
            one = levels[(levels["tips"] == tips) & (levels["relief"] == amount)]
            axes.plot(one["speed"], one["level"], color=colour, label=f"{amount:g} µm")
        for speed in (800, 1000, 1200, 1500):
            axes.axvline(speed, color=MARKER_COLOUR, linestyle=":", linewidth=0.8)
        axes.set(title=f"Relief {where}", xlabel="speed of the pinion [r/min]")
        axes.set_xlim(_SPEEDS[0], _SPEEDS[-1])
    figure.axes[0].set_ylabel("alternating bearing forces, rms [N]")
    figure.axes[0].legend(loc="upper left")
    return {"bearing_forces": figure}


ENTRY = Entry(
    name="relief_bearing_forces",
    group="pair",
    title="Bearing forces with relief",
    source="chapters 2.4 and 6",
    shows="Relief is said to help stabilize the dynamic response; no response with relief is "
    "shown. Dotted lines are the speeds of the thesis.",
    compute=compute,
    draw=draw,
    seconds=12.0,
)

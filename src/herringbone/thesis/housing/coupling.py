"""What it changes that the housing's motion acts back on the bearings."""

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.analysis.steady.state import SteadyState
from herringbone.thesis import names
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.ground import SPEED, natural, settled
from herringbone.thesis.housing.response import FORCES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CURVE = np.arange(600.0, 1700.1, 10.0)
"""[r/min]."""
_RADIAL, _WHEEL, _AXIAL = "pinion radial force", "wheel radial force", "wheel axial force"
_SHOWN = (_RADIAL, _WHEEL, _AXIAL)
_SYSTEMS = (names.GEARBOX, names.RIG)
_BELOW = 1000.0
"""Of natural frequencies that are listed [Hz]."""
_MINOR = 0.1
"""Change that is called minor."""
_WAYS = (("two-way", True), ("one way", False))


def compute() -> Outcome:
    """Bearing forces over speed in both couplings, factors at 1000 r/min, natural frequencies."""
    rows = []
    for way, moving in _WAYS:
        for speed, state in zip(CURVE, settled(CURVE, seats_move=moving), strict=True):
            rows.append({"coupling": way, "speed": speed, **_levels(state)})
    curves = table(pd.DataFrame(rows), {"speed": "r/min", **dict.fromkeys(_SHOWN, "N")})
    factors = table(pd.DataFrame([
        {"system": system, **_factors(system)} for system in _SYSTEMS
    ]))  # fmt: skip
    found = {way: natural(names.GEARBOX, seats_move=m) for way, m in _WAYS}
    listed = [
        {"coupling": way, "frequency": f, "damping ratio": z}
        for way, own in found.items()
        for f, z in zip(own.frequency_hz, own.damping_ratio, strict=True)
        if f < _BELOW
    ]
    frequencies = table(pd.DataFrame(listed), {"frequency": "Hz"})
    outcome = {"curves": curves, "factors": factors, "natural frequencies": frequencies}
    return Outcome(outcome, _findings(curves, factors, frequencies))


def _levels(state: SteadyState) -> dict[str, float]:
    return {name: state.level(FORCES[name]) for name in _SHOWN}


def _factors(system: str) -> dict[str, float]:
    """Levels with the housing's motion over those without, at the thesis' operating point."""
    with_motion, without = (
        _levels(next(iter(settled((SPEED,), seats_move=moving, system=system))))
        for _, moving in _WAYS
    )
    return {name: with_motion[name] / without[name] for name in _SHOWN}


def _findings(
    curves: pd.DataFrame, factors: pd.DataFrame, frequencies: pd.DataFrame
) -> tuple[Finding, ...]:
    rig = factors.set_index("system").loc[names.RIG]
    wide = curves.pivot(index="speed", columns="coupling", values=_WHEEL)
    ratio = wide["two-way"] / wide["one way"]
    lowest = frequencies.groupby("coupling")["frequency"].min()
    told = ", ".join(f"{rig[name]:.2f} ({name})" for name in _SHOWN)
    return (
        Finding(
            "To neglect the flexibility of the gearbox in the dynamic model is a minor difference.",
            Verdict.of((np.abs(rig[list(_SHOWN)].astype(float) - 1.0) < _MINOR).all()),
            float(rig[_AXIAL]),
            "",
            f"times the {_AXIAL} with the housing's motion, on the test rig at 1000 r/min and "
            f"200 N m; all: {told}",
            "The seats are about as soft as the bearings radially, and softer axially.",
            margin=0.1,
        ),
        Finding(
            "It is minor at any speed.",
            Verdict.of((np.abs(ratio - 1.0) < _MINOR).all()),
            float(ratio.max()),
            "",
            f"times the {_WHEEL} at most ({ratio.idxmax():.0f} r/min), {ratio.min():.2f} at least "
            f"({ratio.idxmin():.0f} r/min), from 600 to 1700 r/min",
            "Coupled, the modes of shafts and housing are others.",
            margin=0.1,
        ),
        Finding(
            "Modes of the transmission and of the housing may be computed apart.",
            Verdict.of(abs(lowest["two-way"] / lowest["one way"] - 1.0) < _MINOR),
            float(lowest["two-way"]),
            "Hz",
            f"is the lowest coupled mode, {lowest['one way']:.1f} Hz the lowest of both apart",
        ),
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Bearing forces over speed."""
    from herringbone.plotting.style import figure_legend, new_figure  # noqa: PLC0415 (lazy)

    figure = new_figure("Bearing forces over speed, 200 N m, f_A 10 µm: rms [N]", 1, 3)
    panels = list(figure.subplots(1, 3))
    for axes, name in zip(panels, _SHOWN, strict=True):
        for way, rows in tables["curves"].groupby("coupling", sort=False):
            axes.semilogy(rows["speed"], rows[name], label=way)
        axes.axvline(SPEED, color="#999999", linewidth=0.7, linestyle=":")
        axes.set_title(name)
        axes.set_xlabel("speed [r/min]")
        axes.margins(x=0.0)
    figure_legend(figure, panels[0])
    return {"coupling": figure}


ENTRY = Entry(
    name="one_way_and_two_way",
    group="housing",
    title="One-way against two-way housing",
    source="chapters 4.3 and 5.3.4",
    shows="Bearing forces of a model on rigid ground drive the housing, whose motion does not act "
    "back; differences to the test are put down to it among others, and called minor.",
    compute=compute,
    draw=draw,
    seconds=10.0,
)

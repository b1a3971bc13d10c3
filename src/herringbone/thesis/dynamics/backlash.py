"""The backlash law, where it matters, and the jumps that it makes."""

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.analysis.steady.set_points import Point
from herringbone.analysis.steady.state import SteadyState
from herringbone.core.places.temporary import temporary_folder
from herringbone.running.operating.steady import prepared_solver
from herringbone.running.prepared import Wishes
from herringbone.thesis import names
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.ground import SPEEDS, settled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_TORQUES = (100.0, 200.0, 300.0, 400.0)
_DEFLECTION = f"{names.GEAR}.mesh_left.deflection"
_FORCE = f"{names.BEARINGS}.shaft.pinion_left.f_y"
_LIGHT, _ERROR = 30.0, 1e-6
"""Torque [N m], amplitude of the transmission error at mesh frequency [m]: so teeth part."""
_UP = np.arange(2650.0, 2751.0, 50.0)
_DOWN = np.arange(3100.0, 2649.0, -50.0)
"""Speeds of both sweeps [r/min], about the pinion's radial mode at 1274 Hz."""
_BACKLASH = 180.0
"""2 delta of table 3.1 [µm]."""


def compute() -> Outcome:
    """Least deflection under load, both laws, and sweeps up and down."""
    under_load = table(pd.DataFrame([
        {"torque": torque, "speed": speed, "least": _least(state)}
        for torque in _TORQUES
        for speed, state in zip(SPEEDS, settled(SPEEDS, torque), strict=True)
    ]), {"torque": "N m", "speed": "r/min"})  # fmt: skip
    with temporary_folder() as folder:
        jumps = table(pd.DataFrame(_sweeps(folder)), {"speed": "r/min", "bearing force": "N"})
    return Outcome({"least deflection": under_load, "jumps": jumps}, _findings(under_load, jumps))


def _least(state: SteadyState) -> float:
    """Smallest deflection of the left mesh over its mean."""
    times = np.linspace(0.0, state.period, 64 * state.meshes, endpoint=False)
    values = state.signal(_DEFLECTION, times)
    return float(values.min() / values.mean())


def _sweeps(folder: Path) -> list[dict[str, float | str]]:
    """Levels of sweeps; each ends where no neighbour of the last motion is found."""
    file = folder / "errors.csv"
    rows = [f"{side},drive,pinion,27,{_ERROR!r},0.0" for side in ("left", "right")]
    head = "# units: order 1, amplitude m, phase rad\nside,flank,gear,order,amplitude,phase\n"
    file.write_text(head + "\n".join(rows) + "\n", encoding="utf-8")
    values: dict[str, float | str] = {names.SYMMETRY_DEVIATION: 0.0, names.SEAT_MOTION: 0.0,
              f"{names.GEAR}.tooth_errors": str(file)}  # fmt: skip
    solver, _ = prepared_solver(
        names.GEARBOX, point=Point(torque=_LIGHT), wishes=Wishes(values=values)
    )
    found = []
    for sweep, speeds in (("up", _UP), ("down", _DOWN)):
        near = None
        for speed in speeds:
            near = solver.solve(Point(speed=speed * math.pi / 30.0), near)
            if not near.converged:
                break
            found.append({"sweep": sweep, "speed": speed, "bearing force": near.level(_FORCE),
                          "teeth part": "yes" if near.bends else "no"})  # fmt: skip
    return found


def _findings(under_load: pd.DataFrame, jumps: pd.DataFrame) -> tuple[Finding, ...]:
    least = float(under_load["least"].min())
    wide = jumps.pivot(index="speed", columns="sweep", values="bearing force").dropna()
    ratio = wide["down"] / wide["up"]
    at = float(ratio.idxmax())
    return (
        Finding(
            "Under heavy load the influence of backlash is small.",
            Verdict.of(least > 0.0),
            100.0 * least,
            "%",
            "of the mean deflection stays at the least over 100 to 400 N m and 800 to 1500 r/min: "
            "teeth never part, backlash has no influence at all",
            "With perfect teeth and settled.",
            margin=0.5,
        ),
        Finding(
            "Backlash is retained for generality.",
            Verdict.of(float(ratio.max()) > 1.05),
            float(ratio[at]),
            "",
            f"times the bearing force of the up-sweep has the down-sweep at {at:.0f} r/min, "
            f"{_LIGHT:.0f} N m and a transmission error of {1e6 * _ERROR:g} µm",
            "At light load teeth part near a resonance, and there are two motions at one speed.",
            margin=0.02,
        ),
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Both laws, the least deflection, and both sweeps."""
    from herringbone.plotting.style import new_figure  # noqa: PLC0415 (matplotlib: lazy)

    figure = new_figure("Backlash: the law, heavy load, and jumps at light load", 1, 3)
    law, least, jumps = figure.subplots(1, 3)
    x = np.linspace(-150.0, 150.0, 301)
    half = 0.5 * _BACKLASH
    law.plot(x, np.sign(x) * np.maximum(0.0, np.abs(x) - half), label="thesis: from the middle")
    drive = x + half
    law.plot(drive - half, np.maximum(0.0, x - half) + np.minimum(0.0, x + half),
             linestyle="--", label="here: the same, from the drive flank")  # fmt: skip
    law.set_title("elastic deflection over play [µm]")
    law.set_xlabel("position in the play [µm]")
    _curves(least, tables["least deflection"], "torque", "least", "{:.0f} N m")
    least.set_title("least deflection / mean")
    least.set_ylim(0.0, 1.0)
    _curves(jumps, tables["jumps"], "sweep", "bearing force", "sweep {}")
    jumps.set_title(f"pinion bearing force, rms [N], {_LIGHT:.0f} N m")
    for axes in (law, least, jumps):
        axes.legend(fontsize=7.5)
    for axes in (least, jumps):
        axes.set_xlabel("speed [r/min]")
    return {"backlash": figure}


def _curves(axes: "Axes", rows: pd.DataFrame, split: str, what: str, told: str) -> None:
    for name, own in rows.groupby(split, sort=False):
        axes.plot(own["speed"], own[what], marker="o", markersize=3.5, label=told.format(name))


ENTRY = Entry(
    name="backlash",
    group="dynamics",
    title="The backlash law and its jumps",
    source="chapter 3.3.2, table 3.1",
    shows="A dead zone of 180 µm between both flanks, said to matter little under heavy load.",
    compute=compute,
    draw=draw,
    seconds=10.0,
)

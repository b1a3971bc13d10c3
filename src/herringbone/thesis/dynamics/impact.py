"""The meshing impact over speed and torque, and alone as the excitation."""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.components.registry import component
from herringbone.components.resources.stiffness_table import read_stiffness_table
from herringbone.core.declaring.roles import SIDES
from herringbone.core.places.temporary import temporary_folder
from herringbone.gears.geometry.corner_contact import Impact, meshing_impact
from herringbone.gears.stiffness.slices import SliceMesh
from herringbone.thesis import names
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.ground import SIGNALS, SPEED, TORQUES, levels, settled, unit
from herringbone.thesis.pair.given import JOB
from herringbone.thesis.trends import growth, rises

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SPEEDS = np.arange(800.0, 1500.1, 100.0)
_SHARE = 0.02
"""Of the largest impact that acts: where helical teeth enter, the line of contact has no length."""
_STAGGER = 0.25
"""Mesh periods between the impacts of both halves, where they do not coincide."""
_AXIAL, _RADIAL = "pinion axial velocity", "pinion radial velocity"
_SHOWN = [_AXIAL, _RADIAL]


def compute() -> Outcome:
    """Impacts, and levels if nothing else excites."""
    impacts = table(pd.DataFrame(_impacts()), {"speed": "r/min", "torque": "N m",
                    "velocity": "m/s", "force": "N", "early": "mm"})  # fmt: skip
    with temporary_folder() as folder:
        alone = table(
            pd.DataFrame(_alone(folder)), {"torque": "N m"} | {n: unit(n) for n in SIGNALS}
        )
    return Outcome({"impacts": impacts, "impact only": alone}, _findings(impacts, alone))


def _load(torque: float) -> float:
    """Mean normal force of a half [N]."""
    pair = JOB.pair
    return torque / (2.0 * pair.base_radius[0] * math.cos(pair.base_helix_angle))


def _mean_stiffness(load: float) -> float:
    """Of a half at a load, from the shipped table [N/m]."""
    (loads, secant), _ = read_stiffness_table(
        component(names.GEAR).resources / "mesh_stiffness.csv"
    )
    return float(np.interp(load, loads, secant.mean(axis=1)))


def _impact(speed: float, torque: float) -> Impact:
    load = _load(torque)
    slices = SliceMesh(JOB.pair, calibration=JOB.task().calibration_of("slices"))
    return meshing_impact(JOB.pair, speed * math.pi / 30.0, load / _mean_stiffness(load),
                          slices.single_pair_stiffness(load))  # fmt: skip


def _impacts() -> Iterator[dict[str, float]]:
    for torque in TORQUES:
        for speed in _SPEEDS:
            found = _impact(speed, torque)
            yield {"torque": torque, "speed": speed, "velocity": found.velocity,
                   "force": found.force, "early": 1e3 * found.early_contact}  # fmt: skip


def _alone(folder: Path) -> Iterator[dict[str, float | str]]:
    """Levels with a constant mesh stiffness and a share of the impact."""
    for torque in TORQUES:
        file = folder / f"constant_{torque:.0f}.csv"
        stiffness = _mean_stiffness(_load(torque))
        rows = [f"{side},{load},{phase},{stiffness!r}" for side in SIDES for load in (0.0, 5000.0)
                for phase in (0.0, 0.25, 0.5, 0.75)]  # fmt: skip
        head = "# units: load N, phase 1, stiffness N/m\nside,load,phase,stiffness\n"
        file.write_text(head + "\n".join(rows) + "\n", encoding="utf-8")
        force = _SHARE * _impact(SPEED, torque).force
        for stagger in (0.0, _STAGGER):
            values: dict[str, float | str] = {
                f"{names.GEAR}.stiffness_table": str(file),
                f"{names.GEAR}.impact_force": force,
                f"{names.GEAR}.stagger": stagger,
            }
            (state,) = settled(torque=torque, deviation=0.0, values=values)
            yield {"torque": torque, "halves": _halves(stagger), **levels(state)}


def _halves(stagger: float) -> str:
    return f"{stagger:g} period apart" if stagger else "at the same time"


def _findings(impacts: pd.DataFrame, alone: pd.DataFrame) -> tuple[Finding, ...]:
    by = {how: rows for how, rows in alone.groupby("halves")}
    together, apart = by[_halves(0.0)], by[_halves(_STAGGER)]
    sentence = (
        "With the meshing impact alone, more torque means larger fluctuations of the pinion's"
    )
    at = impacts[(impacts["torque"] == TORQUES[0])].set_index("speed")["force"]
    faster = float(at[_SPEEDS[-1]] / at[_SPEEDS[0]])
    return (
        Finding(
            f"{sentence} axial velocity.",
            Verdict.of(rises(apart[_AXIAL]), assuming=True),
            growth(apart[_AXIAL].to_numpy()),
            "%",
            "change from 200 to 300 N m if the impacts of both halves are a quarter period apart",
            f"If they coincide there is no axial excitation ({together[_AXIAL].iloc[0]:.1g} mm/s).",
            margin=0.1,
        ),
        Finding(
            f"{sentence} radial velocity.",
            Verdict.of(rises(together[_RADIAL])),
            growth(together[_RADIAL].to_numpy()),
            "%",
            f"change from 200 to 300 N m, {together[_RADIAL].iloc[0]:.3g} mm/s at 200 N m",
            f"{_SHARE:g} of the impact over the whole face acts: an assumption for helical teeth.",
            margin=0.1,
        ),
        Finding(
            "The impact velocity, and with it the impact force, goes with speed.",
            Verdict.of(abs(faster / (_SPEEDS[-1] / _SPEEDS[0]) - 1.0) < 1e-6),
            faster,
            "",
            f"times the force at {_SPEEDS[-1]:.0f} against {_SPEEDS[0]:.0f} r/min",
        ),
        Finding(
            "The impact force follows from the compliances of the entering and the other pairs.",
            Verdict.CANNOT_BE_TESTED,
            float(at[SPEED]),
            "N",
            f"per half at {SPEED:.0f} r/min and {TORQUES[0]:.0f} N m, at most, with the entering "
            "pair alone",
            "No value is published. The thesis adds both compliances as if they were in series, "
            "pairs in contact are in parallel; and the line of contact of a helical pair begins "
            "with no length, so that this is an upper bound.",
        ),
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Impact force over speed; levels over torque."""
    from herringbone.plotting.style import new_figure  # noqa: PLC0415 (matplotlib: lazy)

    figure = new_figure("Meshing impact: over speed and torque, and alone as excitation", 1, 3)
    force, *panels = figure.subplots(1, 3)
    for torque, rows in tables["impacts"].groupby("torque"):
        force.plot(rows["speed"], rows["force"], marker="o", markersize=3.5,
                   label=f"{torque:.0f} N m")  # fmt: skip
    force.set_title("largest impact force of a half [N]")
    force.set_xlabel("speed [r/min]")
    for axes, name in zip(panels, _SHOWN, strict=True):
        for halves, rows in tables["impact only"].groupby("halves", sort=False):
            axes.plot(rows["torque"], rows[name], marker="o", label=f"halves {halves}")
        axes.set_title(f"{name}, rms [{unit(name)}]")
        axes.set_xlabel("torque [N m]")
    for axes in (force, *panels):
        axes.set_ylim(bottom=0.0)
        axes.legend(fontsize=7.5)
    return {"impact": figure}


ENTRY = Entry(
    name="meshing_impact",
    group="dynamics",
    title="Meshing impact over speed and torque, and alone",
    source="chapters 3.3.3 and 3.5",
    shows="Impact velocity and force where teeth enter; axial velocity of the pinion for 200, 250 "
    "and 300 N m with the impact alone, said to grow with torque.",
    compute=compute,
    draw=draw,
    seconds=2.0,
)

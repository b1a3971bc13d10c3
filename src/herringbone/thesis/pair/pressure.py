"""Contact pressure on both halves under partial load, figures 2.3 and 2.4."""

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.gears import MeshStiffness
from herringbone.gears.load.flank_load import FlankLoad, axial_position, flank_load
from herringbone.gears.load.loaded_pair import Symmetry, loaded_pair
from herringbone.gears.stiffness.coupled_slices import CoupledSliceMesh
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.pair.finite_elements import by_elements
from herringbone.thesis.pair.given import JOB
from herringbone.thesis.pair.holding import HELD

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import QuadMesh
    from matplotlib.figure import Figure

_TORQUE = 200.0
_CASES = {
    "no deviation": Symmetry(),
    "20 µm, pinion floating": Symmetry(20e-6),
    "20 µm, pinion held by 10⁸ N/m": Symmetry(20e-6, HELD),
}
_NONE, _FLOATING, _HELD = _CASES
_SIDES = ("left", "right")
_CLEARLY = 1.25
"""Pressure of one side over the other that a map shows."""
_EVERY = 2
"""Of phases and of the places of the map: half of them show the same."""


def compute() -> Outcome:
    """Pressure on the flanks, by coupled slices at the loads of the halves over a mesh period."""
    stiffness, mesh = by_elements(), CoupledSliceMesh(JOB.pair)
    maps, most = [], []
    for case, symmetry in _CASES.items():
        for number, side in enumerate(_SIDES):
            found = _flank(stiffness, mesh, symmetry, number)
            share = 100.0 * _share(stiffness, symmetry, number)
            most.append((case, side, share, 1e-6 * float(found.pressure.mean())))
            maps.append(_map(case, side, number, found))
    means = pd.DataFrame(most, columns=["case", "side", "share", "mean_pressure"])
    flank = pd.concat(maps, ignore_index=True)
    return Outcome(
        {
            "means": table(means.to_dict("list"), {"share": "%", "mean_pressure": "MPa"}),
            "flanks": table(
                flank.to_dict("list"), {"axial": "mm", "path": "mm", "pressure": "MPa"}
            ),
        },
        _findings(means.set_index(["case", "side"])),
    )


def _flank(
    stiffness: MeshStiffness, mesh: CoupledSliceMesh, symmetry: Symmetry, side: int
) -> FlankLoad:
    half = loaded_pair(stiffness, _TORQUE, symmetry).halves[side]
    return flank_load(mesh, JOB.pair, half.phases[::_EVERY], half.force[::_EVERY])


def _share(stiffness: MeshStiffness, symmetry: Symmetry, side: int) -> float:
    left = loaded_pair(stiffness, _TORQUE, symmetry).share_left
    return left if side == 0 else 1.0 - left


def _map(case: str, side: str, number: int, found: FlankLoad) -> pd.DataFrame:
    axial = 1e3 * axial_position(JOB.pair, number, found.face[::_EVERY])
    path = 1e3 * found.path[::_EVERY]
    grid = np.meshgrid(path, axial, indexing="ij")
    pressure = 1e-6 * found.pressure[::_EVERY, ::_EVERY]
    return pd.DataFrame(
        {"case": case, "side": side, "path": grid[0].ravel(), "axial": grid[1].ravel(),
         "pressure": pressure.ravel()}
    )  # fmt: skip


def _findings(means: pd.DataFrame) -> tuple[Finding, ...]:
    pressure = means["mean_pressure"]
    held = pressure[(_HELD, "left")] / pressure[(_HELD, "right")]
    floating = pressure[(_FLOATING, "left")] / pressure[(_FLOATING, "right")]
    return (
        Finding(
            "Under partial load the contact stress of both sides is clearly asymmetric.",
            Verdict.needing(floating > _CLEARLY, held > _CLEARLY),
            held,
            "",
            f"mean pressure left over right, {_HELD}, {_TORQUE:g} N m",
            f"The pinion must be held axially; floating the ratio is {floating:.3f}.",
        ),
        Finding(
            "Contours of the contact stress are shown, without values.",
            Verdict.CANNOT_BE_TESTED,
            pressure[(_NONE, "left")],
            "MPa",
            f"mean pressure (Hertz) on the flanks without deviation at {_TORQUE:g} N m",
            "No stress is published, nor the torque.",
        ),
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Left and right half as they lie on the pair, a row for each case."""
    from herringbone.plotting.style import new_figure  # noqa: PLC0415 (lazy)

    flanks, means = tables["flanks"], tables["means"].set_index(["case", "side"])
    figure = new_figure(
        f"Contact pressure on both halves, {_TORQUE:g} N m at the pinion", len(_CASES), 2
    )
    panels = figure.subplots(len(_CASES), 2, sharey=True)
    top = flanks["pressure"].max()
    for row, case in zip(panels, _CASES, strict=True):
        for axes, side in zip(row, _SIDES, strict=True):
            one = flanks[(flanks["case"] == case) & (flanks["side"] == side)]
            shown = _shown(axes, one, top)
            told = means.loc[(case, side)]
            axes.set_title(
                f"{side}, {case}: {told['share']:.0f} % of the load, mean "
                f"{told['mean_pressure']:.0f} MPa",
                fontsize=8.5,
            )
        row[0].set_ylabel("path of contact, A to E [mm]")
    for axes in panels[-1]:
        axes.set_xlabel("axial, from the middle of the pair [mm]")
    figure.subplots_adjust(right=0.9)
    beside = figure.add_axes((0.93, 0.1, 0.015, 0.78))
    figure.colorbar(shown, cax=beside, label="pressure [MPa]")
    return {"pressure": figure}


def _shown(axes: "Axes", one: pd.DataFrame, top: float) -> "QuadMesh":
    """A map; the left end of the pair on the left."""
    grid = one.pivot_table(index="path", columns="axial", values="pressure")
    axes.grid(visible=False)
    axes.set_xlim(grid.columns.max(), grid.columns.min())
    return axes.pcolormesh(
        grid.columns, grid.index, grid.to_numpy(),
        cmap="viridis", vmin=0.0, vmax=top, shading="gouraud", rasterized=True,
    )  # fmt: skip


ENTRY = Entry(
    name="contact_pressure",
    group="pair",
    title="Contact pressure left and right",
    source="chapter 2.3, figures 2.3 and 2.4",
    shows="Contour plots of the contact stress under partial load, in which the asymmetry of both "
    "sides is clearly visible; no values.",
    compute=compute,
    draw=draw,
    seconds=6.0,
)

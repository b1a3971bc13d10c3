"""Mesh stiffness of the pair by finite elements, with and without relief: a file.

`python -m herringbone.thesis.pair.finite_elements` writes it anew; it takes the extra 'fe' and a
few minutes the first time. Everything else reads the file, which is committed, so that a report
takes no finite elements.
"""

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd

from herringbone.core.places.files import write_whole
from herringbone.gears import MeshStiffness, Modification
from herringbone.gears.files.table_file import origin
from herringbone.gears.stiffness.methods import mesh_stiffness
from herringbone.thesis.pair.given import JOB

FILE = Path(__file__).with_name("data") / "finite_elements.csv"
TORQUES = (
    *(50.0, 100.0, 200.0, 400.0, 700.0, 1000.0, 1250.0, 1500.0, 1750.0, 2000.0),
    *(3000.0, 4000.0, 5000.0, 6500.0, 8000.0, 11000.0, 15000.0, 20000.0),
)
"""Of the pinion [N m]; the table begins at zero."""
LENGTH = 3e-3
"""h of the thesis' parabola, along the path of contact [m]."""
RELIEFS: Mapping[str, tuple[float, float]] = {
    "none": (0.0, 0.0),
    "pinion 5": (5e-6, 0.0),
    "pinion 10": (10e-6, 0.0),
    "both 5": (5e-6, 5e-6),
    "both 10": (10e-6, 10e-6),
}
"""Relief at the tips of pinion and wheel [m], by name: at which tips, how many micrometres."""

_HEAD = (
    "units: load N, phase 1, deflection m, tangent N/m",
    "Deflection normal to the flank, and tangent stiffness, of one half at its own normal force.",
    "Made by python -m herringbone.thesis.pair.finite_elements",
    "Relief: at the tip of the pinion or at both tips, in um, parabolic over 3 mm.",
)
_COLUMNS = "relief,load,phase,deflection,tangent"


def modification(relief: str) -> Modification:
    """Flanks with a relief of `RELIEFS`."""
    return Modification(tip_relief=RELIEFS[relief], relief_length=LENGTH)


def loads() -> list[float]:
    """Normal forces of a half at the torques, from zero [N]."""
    return [0.0, *(JOB.pair.tooth_forces(torque).normal for torque in TORQUES)]


@cache
def by_elements(relief: str = "none") -> MeshStiffness:
    """Mesh stiffness of one half by finite elements, from the file.

    Args:
        relief: of `RELIEFS`.
    """
    every = _rows()
    rows = every[every["relief"] == relief]
    shape = (rows["load"].nunique(), rows["phase"].nunique())
    tangent = rows["tangent"].to_numpy().reshape(shape)
    return MeshStiffness(
        JOB.pair,
        modification(relief),
        "finite elements",
        np.array(loads()),
        np.arange(shape[1]) / shape[1],
        rows["deflection"].to_numpy().reshape(shape),
        tangent,
        tangent[0],
    )


@cache
def _rows() -> pd.DataFrame:
    return pd.read_csv(FILE, comment="#")


def file_text() -> str:
    """The file: computed."""
    rows, told = [], []
    for relief in RELIEFS:
        task = replace(JOB.task(), loads=loads(), modification=modification(relief))
        found = mesh_stiffness(task, "fe")
        _, pair, *_, method = origin(found)
        told = [pair, method]
        for load, *both in zip(found.loads, found.deflection, found.tangent, strict=True):
            for phase, deflection, tangent in zip(found.phases, *both, strict=True):
                numbers = f"{load:.3f},{phase:.6f},{deflection:.7e},{tangent:.6e}"
                rows.append(f"{relief},{numbers}")
    return "\n".join([*(f"# {line}" for line in (*_HEAD, *told)), _COLUMNS, *rows, ""])


if __name__ == "__main__":
    write_whole(FILE, file_text())

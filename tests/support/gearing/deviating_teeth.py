"""Files of teeth that deviate, and their contact by the gear pair's kernel."""

from pathlib import Path

import numpy as np

from herringbone.components.gear_mesh.teeth import toothed
from herringbone.core import Instance
from herringbone.gears import GearPair
from herringbone.gears.accuracy.deviations import deviations
from herringbone.gears.files.pair_law_file import pair_law_text, tooth_deviations_text
from herringbone.gears.stiffness.pair_law import pair_law
from herringbone.gears.stiffness.point_mesh import PointMesh
from herringbone.gears.stiffness.slices import SliceMesh
from support.gearing.gears import THESIS

PAIR = GearPair(**THESIS)
UNIT = 1e-5
"""D of the laws [m]."""


def write_law(file: Path, mesh: SliceMesh | PointMesh) -> Path:
    """Law of one pair of teeth, by a mesh."""
    file.write_text(pair_law_text(pair_law(mesh, UNIT)))
    return file


def write_teeth(file: Path, grade: int, seed: int = 7, *, coast: bool = False) -> Path:
    """Deviations of both halves of the thesis' pair, by a class; of the coast flanks, too."""
    drive, other = (
        [deviations(PAIR, grade, seed, half, coast=flank) for half in range(2)]
        for flank in (False, True)
    )
    file.write_text(tooth_deviations_text(PAIR, drive, other if coast else ()))
    return file


def mirrored_teeth(file: Path, other: Path) -> Path:
    """The teeth seen from the other side: halves exchanged, the flanks coast flanks."""
    swapped = {"left,drive": "right,coast", "right,drive": "left,coast"}
    lines = file.read_text().splitlines()
    for i, line in enumerate(lines):
        for old, new in swapped.items():
            if line.startswith(old):
                lines[i] = line.replace(old, new)
    other.write_text("\n".join(lines) + "\n")
    return other


def deflections(gear: Instance, phases: np.ndarray, force: float, ramp: float = 1.0) -> np.ndarray:
    """(n,) depth of ideal teeth [m] at which the left drive flank has a force [N]."""
    found, depth = [], 0.0
    for phase in phases.tolist():
        low, high = -1e-4, 3e-4
        for _ in range(100):
            pressure, tangent, *_ = toothed(gear.block, 0, 0, phase, depth, ramp)
            low, high = (low, depth) if pressure > force else (depth, high)
            if abs(pressure - force) < 1e-9 * force:
                break
            newton = depth + (force - pressure) / tangent if tangent > 0.0 else high
            depth = newton if low < newton < high else 0.5 * (low + high)
        found.append(depth)
    return np.array(found)

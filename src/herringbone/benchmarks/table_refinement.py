"""What a finer stiffness table changes in the bearing forces of the test rig, over its speeds.

    python -m herringbone.benchmarks.table_refinement

runs the rig with the shipped table, and with tables of the same pair made by finer finite elements:
some ten minutes on two cores. The result stands in `gears.finite_elements.compliance`.
"""

import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.asked import group
from herringbone.analysis.figures.operating_point import steady_part
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.cosim.algorithms import LI
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.gears.files.shipped_table import GEAR_FILE
from herringbone.gears.files.table_file import write_table
from herringbone.gears.finite_elements.convergence import finer_meshes, solved
from herringbone.gears.job import GearJob
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness
from herringbone.result.result import Result
from herringbone.running.api import run
from herringbone.running.loading import load_system

SPEEDS = (800.0, 1000.0, 1200.0, 1500.0)
"""Of the pinion [r/min]."""
_SCENE_SPEED = 1000.0
_SYSTEM, _SCENE = "test_rig", "loaded"


def finer_tables(job: GearJob) -> Iterator[tuple[str, MeshStiffness]]:
    """Tables at the loads of a job, of each finer mesh."""
    for name, mesh, phases in finer_meshes(job.pair):
        yield name, solved(mesh, job.task().loads, phases)


def bearing_forces(table: Path | None = None) -> np.ndarray:
    """(speeds,) rms of the alternating part of all bearing forces of the rig [N].

    Args:
        table: of the gear pair; None: the shipped one.
    """
    system, _ = load_system(_SYSTEM)
    parts = anatomy(system)
    (gear,), (controller,) = parts.with_role(Role.GEAR_PAIR), parts.with_role(Role.CONTROLLER)
    values: dict[str, float | str] = {}
    if table is not None:
        values[str(parts.column(gear, Quantity.STIFFNESS_TABLE))] = str(table)
    equal_steps, found = LI(), []  # far below what finer tables change, unlike a tolerance
    for speed in SPEEDS:
        at_speed = {f"{controller}.speed_factor": speed / _SCENE_SPEED}
        at = {**values, **at_speed}
        found.append(_alternating(run(_SYSTEM, scene=_SCENE, algorithm=equal_steps, values=at)))
    return np.array(found)


def _alternating(result: Result) -> float:
    forces = result.data[group(result, "bearing_force")].to_numpy()[steady_part(result).rows]
    return float(np.linalg.norm(forces.std(axis=0)))


def refinement_table() -> str:
    """What each finer table changes, relative to it, as text."""
    shipped = bearing_forces()
    rows = [f"{'bearing force against':36} {' '.join(f'{s:6.0f}' for s in SPEEDS)} r/min"]
    with tempfile.TemporaryDirectory() as folder:
        for name, stiffness in finer_tables(read_gear_file(GEAR_FILE)):
            file = Path(folder) / "finer.csv"
            write_table(stiffness, file)
            change = 100.0 * (shipped / bearing_forces(file) - 1.0)
            rows.append(f"{name:36} {' '.join(f'{value:6.2f}' for value in change)} %")
    return "\n".join(rows)


if __name__ == "__main__":
    sys.stdout.write(refinement_table() + "\n")

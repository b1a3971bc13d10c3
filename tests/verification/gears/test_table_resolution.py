"""The motion of the rig does not depend on the resolution of the stiffness table."""

from dataclasses import replace

import numpy as np
import pytest

import herringbone as hb
from herringbone.analysis.accuracy.error import relative_error
from herringbone.components.ports import HALVES
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.gears.files.shipped_table import GEAR_FILE
from herringbone.gears.files.table_file import write_table
from herringbone.gears.stiffness.methods import mesh_stiffness

FORCES = [f"bearing_supports.shaft.{half}.f_{axis}" for half in HALVES for axis in "yz"]
ERRORS = [
    "gear_mesh.transmission_error",
    *(f"gear_mesh.mesh_{side}.deflection" for side in ("left", "right")),
]


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """The rig with the shipped table, and with twice its phases and loads."""
    task = read_gear_file(GEAR_FILE).task()
    loads = np.asarray(task.loads)
    between = np.sort(np.concatenate([loads, 0.5 * (loads[1:] + loads[:-1])]))
    fine = tmp_path_factory.mktemp("tables") / "fine.csv"
    write_table(mesh_stiffness(replace(task, phases=128, loads=between)), fine)
    return [
        hb.run("test_rig", t_end=0.02, fmu="in-process", values=values)
        for values in ({}, {"gear_mesh.stiffness_table": str(fine)})
    ]


@pytest.mark.parametrize("columns", [FORCES, ERRORS], ids=["bearing forces", "mesh"])
def test_motion(runs, columns):
    """Within 0.1 % of the vibration, in the norm that errors of the coupling are measured in."""
    shipped, fine = (run.data[run.columns(*columns)].to_numpy() for run in runs)
    assert relative_error(shipped, fine) < 1e-3

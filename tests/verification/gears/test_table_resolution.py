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
from herringbone.gears.job_stiffness import stiffness_for

FORCES = [f"bearing_supports.shaft.{half}.f_{axis}" for half in HALVES for axis in "yz"]
ERRORS = [
    "gear_mesh.transmission_error",
    *(f"gear_mesh.mesh_{side}.deflection" for side in ("left", "right")),
]


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """The rig with the shipped table, and with twice its loads or its phases."""
    job = read_gear_file(GEAR_FILE)
    loads = np.asarray(job.task().loads)
    between = np.sort(np.concatenate([loads, 0.5 * (loads[1:] + loads[:-1])]))
    tables = {"shipped": {}}
    for name, finer in (
        ("loads", replace(job, loads=between.tolist())),
        ("phases", replace(job, phases=128)),
    ):
        file = tmp_path_factory.mktemp("tables") / f"{name}.csv"
        write_table(stiffness_for(finer), file)
        tables[name] = {"gear_mesh.stiffness_table": str(file)}
    return {
        name: hb.run("test_rig", t_end=0.02, fmu="in-process", values=values)
        for name, values in tables.items()
    }


@pytest.mark.slow
@pytest.mark.parametrize("columns", [FORCES, ERRORS], ids=["bearing forces", "mesh"])
@pytest.mark.parametrize(("finer", "limit"), [("loads", 1e-3), ("phases", 1e-2)])
def test_motion(runs, columns, finer, limit):
    """Of the vibration, in the norm that errors of the coupling are measured in.

    The stiffness of finite elements has kinks where a contact line enters, which 32 harmonics
    round: 0.6 % of the vibration, an eighth of what the mesh may leave.
    """
    one, other = (runs[name].data[runs[name].columns(*columns)] for name in ("shipped", finer))
    assert relative_error(one.to_numpy(), other.to_numpy()) < limit

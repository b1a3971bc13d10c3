"""The gear_mesh component turns with another pair."""

import math
from pathlib import Path

import pytest

import herringbone as hb
from herringbone.gears.files.rexs import read_rexs_job
from herringbone.gears.job import GearJob

STAGE = Path(__file__).parents[2] / "gear_stage.rexs"
TORQUE = 300.0


def test_stage_of_a_rexs_file_in_the_gearbox():
    """z 27/51, 21 deg: the mean normal force of a half is T1 / (2 r_b1 cos(beta_b))."""
    pair = read_rexs_job(STAGE, halves=2).pair
    job = GearJob(pair, torque=TORQUE, method="coupled-slices")
    values = {"gear_mesh.pinion.tau": TORQUE}
    result = hb.run("gearbox", t_end=0.01, fmu="in-process", gear=job, values=values)
    assert result.outcome.completed
    normal = TORQUE / (2.0 * pair.base_radius[0] * math.cos(pair.base_helix_angle))
    for side in ("left", "right"):
        force = result[f"gear_mesh.mesh_{side}.force"]
        assert force.mean() == pytest.approx(normal, rel=2e-3)
        assert 1e-3 < force.std() / normal < 0.1
    assert result["gear_mesh.mesh_left.deflection"].min() > 0.0

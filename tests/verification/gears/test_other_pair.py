"""The gear_mesh component turns with the files that the gear command writes for another pair."""

import math
import tomllib
from pathlib import Path

import pytest

import herringbone as hb
from herringbone.commands.gear.report import gear
from herringbone.gears.files.rexs import read_rexs

STAGE = Path(__file__).parents[2] / "gear_stage.rexs"
TORQUE = 300.0


def test_stage_of_a_rexs_file_in_the_gearbox(tmp_path):
    """z 27/51, 21 deg: the mean normal force of a half is T1 / (2 r_b1 cos(beta_b))."""
    gear(STAGE, tmp_path, method="coupled-slices", torque=TORQUE, halves=2)
    pair = read_rexs(STAGE, halves=2)
    values = tomllib.loads((tmp_path / "gear_mesh.toml").read_text(encoding="utf-8"))["set"]
    values["gear_mesh.stiffness_table"] = str(tmp_path / "mesh_stiffness.csv")
    values["gear_mesh.pinion.tau"] = TORQUE
    values["gear_mesh.wheel.tau"] = -TORQUE * pair.gear_ratio
    result = hb.run("gearbox", t_end=0.01, fmu="in-process", values=values)
    assert result.outcome.completed
    normal = TORQUE / (2.0 * pair.base_radius[0] * math.cos(pair.base_helix_angle))
    for side in ("left", "right"):
        force = result[f"gear_mesh.mesh_{side}.force"]
        assert force.mean() == pytest.approx(normal, rel=2e-3)
        assert 1e-3 < force.std() / normal < 0.1
    assert result["gear_mesh.mesh_left.deflection"].min() > 0.0

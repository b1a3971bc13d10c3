"""The gear_mesh component turns with the scene that the gear command writes for another pair."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

import herringbone as hb
from herringbone.commands.gear.report import gear
from herringbone.gears.files.rexs import read_rexs
from herringbone.scenes import read_scene

STAGE = Path(__file__).parents[2] / "gear_stage.rexs"
TORQUE = 300.0


def test_stage_of_a_rexs_file_in_the_gearbox(tmp_path):
    """z 27/51, 21 deg: the mean normal force of a half is T1 / (2 r_b1 cos(beta_b))."""
    gear(STAGE, tmp_path, method="coupled-slices", torque=TORQUE, halves=2)
    pair = read_rexs(STAGE, halves=2)
    scene = read_scene(tmp_path / "gear_mesh.toml")
    load = {"gear_mesh.pinion.tau": TORQUE, "gear_mesh.der(angle)": 104.7}
    scene = replace(scene, values={**scene.values, **load})
    result = hb.run("gearbox", scene=scene, t_end=0.01, fmu="in-process")
    assert result.outcome.completed
    normal = TORQUE / (2.0 * pair.base_radius[0] * math.cos(pair.base_helix_angle))
    for side in ("left", "right"):
        force = result[f"gear_mesh.mesh_{side}.force"]
        assert force.mean() == pytest.approx(normal, rel=2e-3)
        assert 1e-3 < force.std() / normal < 0.1
    assert result["gear_mesh.mesh_left.deflection"].min() > 0.0

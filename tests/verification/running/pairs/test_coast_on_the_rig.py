"""The test rig under coast load, through zero torque, turning backwards, with real teeth."""

import math

import numpy as np
import pytest
from support.gearing.gear_mesh import write_errors

import herringbone as hb

NORMAL = 200.0 / (2.0 * 50.298e-3 * math.cos(0.4891167))
"""Mean normal force of a half at 200 N m [N]."""
COAST = "gearbox.gear_mesh: the coast flank carries; y is its line of action"
HALVES = ("pinion_left", "wheel_left")
REVERSAL = ((0.0, 1000, 200), (0.02, 1000, 200), (0.06, 1000, -200))


def rig(folder, cycle, t_end, **values):
    """A run under a cycle of times [s], speeds [r/min] and pinion torques [N m]."""
    file = folder / "cycle.csv"
    rows = "\n".join(",".join(map(str, row)) for row in cycle)
    head = "# units: time s, speed r/min, torque N.m\ntime,speed,torque\n"
    file.write_text(f"{head}{rows}\n", encoding="utf-8")
    values["bench_controller.cycle"] = file
    return hb.run("test_rig", t_end=t_end, fmu="in-process", values=values)


@pytest.mark.parametrize(("speed", "torque"), [(1000, -200), (-1000, 200), (-1000, -200)])
def test_steady_start_in_all_quadrants(speed, torque, tmp_path):
    """Torque decides on the flank, whatever way the shafts turn."""
    result = rig(tmp_path, [(0.0, speed, torque)], 0.02)
    assert result.outcome.completed
    assert (COAST in result.info.notes) == (torque < 0.0)
    assert not any("flank is loaded" in note for note in result.info.notes)
    sign = math.copysign(1.0, torque)
    for side in ("left", "right"):
        force = result[f"gear_mesh.mesh_{side}.force"]
        assert force.mean() == pytest.approx(sign * NORMAL, rel=2e-3)
        assert (sign * force).min() > 0.9 * NORMAL
    assert result["drive_coupling.torque"].iloc[0] == pytest.approx(torque, rel=1e-3)
    assert result["gear_mesh.pinion.w"].mean() == pytest.approx(speed * math.pi / 30.0, rel=1e-3)


def test_torque_through_zero_completes_with_a_note(tmp_path):
    """y stays along the drive flank; the coast flank is loaded from 40 ms on, teeth rattle between.

    The note's time is that with either mesh below zero, counted at the records.
    """
    result = rig(tmp_path, REVERSAL, 0.2)
    assert result.outcome.completed
    assert COAST not in result.info.notes
    assert result.info.parameters["gearbox.gear_mesh.flank"] == 1.0
    sides = [result[f"gear_mesh.mesh_{side}.force"].to_numpy() for side in ("left", "right")]
    assert sides[0][0] == pytest.approx(NORMAL, rel=0.05)
    assert np.mean(sides[0][result["time"] > 0.15]) == pytest.approx(-NORMAL, rel=0.1)
    coast = 200.0 * np.mean((sides[0] < 0.0) | (sides[1] < 0.0))
    assert 120.0 < coast < 165.0
    (line,) = (note for note in result.info.notes if "flank is loaded" in note)
    wanted = "gearbox.gear_mesh: the coast flank is loaded for "
    assert line.startswith(wanted)
    assert float(line.removeprefix(wanted).split()[0]) == pytest.approx(coast, rel=1e-3)
    assert "y is the line of action of the drive flank" in line
    # Coast carries for more than half of the run.
    assert 'values={"gearbox.gear_mesh.flank": -1, "gearbox.bearing_supports.flank": -1}' in line


@pytest.mark.parametrize("torque", [200, -200])
def test_start_with_deviations_and_unbalance(torque, tmp_path):
    """The first 5 ms swing no more than twice as far as the last, with what turns and is uneven."""
    deviations = (("pinion", 1, 5e-6, 1.2), ("wheel", 1, 10e-6, 2.0), ("pinion", 27, 5e-7, 0.0))
    errors = write_errors(
        tmp_path / "errors.csv",
        [(side, flank, *d) for d in deviations for side in ("left", "right")
         for flank in ("drive", "coast")],
    )  # fmt: skip
    unbalance = {"gear_mesh.pinion.unbalance": 3e-4, "gear_mesh.wheel.unbalance": 2e-2}
    values = {"gear_mesh.tooth_errors": errors, **unbalance}
    result = rig(tmp_path, [(0.0, 1000, torque)], 0.18, **values)
    assert result.outcome.completed
    time = result["time"].to_numpy()
    for half in HALVES:
        force = result[f"bearing_supports.shaft.{half}.f_y"].to_numpy()
        swing = np.abs(force - force.mean())
        assert swing[time > 0.12].max() > 10.0
        assert swing[time < 0.005].max() < 2.0 * swing[time > 0.12].max()

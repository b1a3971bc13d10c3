"""The thesis' own model: gears in bearings on rigid ground, torques on the bodies."""

import numpy as np
import pytest

import herringbone as hb
from herringbone.analysis.figures.misfits import misfits

STILL = {"gear_mesh.symmetry_deviation": 0.0}
COLUMNS = "gear_mesh.pinion_left.v_y", "bearing_supports.shaft.wheel_left.f_y"


def test_it_is_the_gearbox_without_the_motion_of_its_seats():
    """Two ways to put bearings on the ground, and to load the gears."""
    ground = hb.steady("on_ground", values=STILL, tolerance=1e-5)
    values = {**STILL, "bearing_supports.seat_motion": 0.0}
    gearbox = hb.steady("gearbox", torque=200.0, values=values, tolerance=1e-5)
    for column in COLUMNS:
        assert ground.level(column) == pytest.approx(gearbox.level(column), rel=1e-4)
    assert ground.notes == ()


def test_gradual_start():
    """Load and its reaction rise in line over 0.02 s; gears turn at speed from the start."""
    result = hb.run("on_ground", scene="gradual", fuse=True)
    time = result["time"].to_numpy()
    share = np.minimum(1.0, time / 0.02)
    for part, torque in (("pinion", 200.0), ("wheel", -600.0)):
        found = result[f"{part}_torque.torque_setpoint"].to_numpy()
        np.testing.assert_allclose(found, torque * share, atol=1e-6)
    speed = result["gear_mesh.pinion.w"].to_numpy()
    np.testing.assert_allclose(speed, 1000.0 * np.pi / 30.0, rtol=0.02)
    assert result.data[[result.column(c) for c in COLUMNS]].iloc[0].abs().max() == 0.0


def test_its_torques_are_those_of_one_load():
    """The pinion's controller has the ratio 1, which is no misfit beside the wheel's."""
    result = hb.run("on_ground", t_end=1e-3, fuse=True)
    assert not [line for line in misfits(result) if "gear ratio" in line]
    values = {"wheel_torque.gear_ratio": 2.0}
    wrong = hb.run("on_ground", t_end=1e-3, fuse=True, start="rest", values=values)
    assert len([line for line in misfits(wrong) if "gear ratio" in line]) == 2

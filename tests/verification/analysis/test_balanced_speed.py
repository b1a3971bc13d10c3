"""A drivetrain whose speed is where its torques balance, far from where its search begins."""

import numpy as np
import pytest

from herringbone.analysis.balanced_angle import NoBalanceError
from herringbone.analysis.equilibrium import equilibrium
from herringbone.running.loading import load_system

NOMINAL, TORQUE, DROOP, RATED, RATIO = 300.0, 150.0, 29.0, -358.0, 3.0
SYSTEM = f"""
name = "drive"
connections = [
  ["emotor.flange", "rotor.flange_a"], ["rotor.flange_b", "shaft.flange_a"],
  ["gearbox.pinion", "shaft.flange_b"], ["gearbox.wheel", "out.flange_a"],
  ["machine.flange_a", "out.flange_b"], ["machine.flange_b", "load.flange"],
]
[parts]
rotor = {{ component = "rotating_inertia", set = {{ inertia = 0.034 }} }}
shaft = {{ component = "shaft_coupling", set = {{ stiffness = 2.2e4, damping = 2.0 }} }}
gearbox = {{ system = "gearbox" }}
out = {{ component = "shaft_coupling", set = {{ stiffness = 9e4, damping = 20.0 }} }}
machine = {{ component = "rotating_inertia", set = {{ inertia = 3.1 }} }}
[parts.emotor]
component = "torque_source"
set = {{ nominal_torque = {TORQUE}, nominal_speed = {NOMINAL} }}
[parts.load]
component = "torque_source"
set = {{ nominal_torque = {RATED}, nominal_speed = 125.7, quadratic_share = 1.0 }}
"""


@pytest.fixture
def drive(tmp_path):
    (tmp_path / "system.toml").write_text(SYSTEM, encoding="utf-8")
    return load_system(tmp_path)[0]


def governed(drive, **values):
    motor = {"emotor.constant_share": 1.0 + DROOP, "emotor.linear_share": -DROOP}
    return drive.with_values(motor | values)


def balance(setpoint):
    """Root [rad/s] of the motor's torque and the load's, at the pinion."""
    square = RATED / (125.7 * RATIO) ** 2 / RATIO
    slope = -TORQUE * DROOP / NOMINAL
    at_zero = TORQUE * (1.0 + DROOP) + setpoint / RATIO
    return (-slope - np.sqrt(slope**2 - 4.0 * square * at_zero)) / (2.0 * square)


@pytest.mark.parametrize(("start", "setpoint"), [(300.0, 70.0), (100.0, 250.0), (1000.0, 60.0)])
def test_speed_at_which_a_governor_and_a_fan_balance(drive, start, setpoint):
    """Beside them the angle of the mesh: half its squared deflection times its stiffness' slope."""
    values = {"gearbox.gear_mesh.der(angle)": start, "load.torque_setpoint": setpoint}
    found = equilibrium(governed(drive, **values)).values["gearbox.gear_mesh.der(angle)"]
    mesh = 2.0 * 0.5 * 3e9 * (1e-5) ** 2
    assert found == pytest.approx(balance(setpoint), abs=mesh / (TORQUE * DROOP / NOMINAL))


def test_torques_that_balance_at_no_speed(drive):
    constant = {"emotor.constant_share": 1.0, "load.quadratic_share": 0.0}
    constant |= {"load.nominal_torque": 0.0, "gearbox.gear_mesh.der(angle)": 300.0}
    with pytest.raises(NoBalanceError, match=r"rotor\.speed changes by \d.* rad/s\^2 at .* and by"):
        equilibrium(drive.with_values(constant))

"""How fast a rotor behind its own shaft turns, by its torque while the flange is held."""

import math

import numpy as np
import pytest

from herringbone.cosim.signature.inner_speeds import inner_speeds
from herringbone.cosim.signature.rotation import InputRule

STIFFNESS, INERTIA, STEP = 5e4, 0.06, 2e-5


class Rotor:
    """Trials of a rotor at a speed behind a twisted shaft: torque, and a temperature."""

    def __init__(self, speed, flange, turning, damping):
        self.inputs = ("load", "phi", "w")
        self.step, self.start = STEP, np.array([0.0, 0.0, flange])
        self._speed, self._turning, self._damping = speed, turning, damping
        self._load = STIFFNESS * 1e-3

    def drive(self, torque):
        """Besides what the shaft carries at the start [N m]."""
        self._load += torque

    def run(self, inputs, h):
        angle, speed, flange, count = 1e-3, self._speed, 0.0, 1000
        for _ in range(count):
            torque = STIFFNESS * (angle - flange) + self._damping * (speed - inputs[0][2])
            speed += h / count * (self._load - torque) / INERTIA
            angle += h / count * speed
            flange += h / count * inputs[0][2] * self._turning
        torque = STIFFNESS * (angle - flange) + self._damping * (speed - inputs[0][2])
        return np.array([[300.0, 0.0], [300.0, torque]])


@pytest.mark.parametrize("damping", [8.0, 40.0])
@pytest.mark.parametrize("turning", [False, True])
@pytest.mark.parametrize(("speed", "flange"), [(0.0, 104.7), (104.7, 104.7), (50.0, 0.0)])
def test_speed_of_a_rotor(speed, flange, turning, damping):
    """The torque of a damper of 8 N m s/rad moves the rotor by 2 % of what is between both speeds
    in the time that tells the torque's rate, 40 by half; what is left is of second order in steps.
    """
    lab = Rotor(speed, flange, turning, damping)
    feedthrough = np.array([[0.0, 0.0, 0.0], [0.0, -STIFFNESS, -damping]])
    rules = (InputRule.MEAN, InputRule.START if turning else InputRule.MEAN, InputRule.MEAN)
    load, found, rate = inner_speeds(lab, feedthrough, rules, (-1, 2, -1))
    assert math.isnan(load)
    assert math.isnan(rate)
    assert found == pytest.approx(speed, abs=0.5)


@pytest.mark.parametrize("turning", [False, True])
def test_what_drives_a_rotor_at_rest_turns_nothing_yet(turning):
    """Its damper feels the acceleration: 8 N m s/rad at 1257 N m looked like 3 rad/s."""
    lab = Rotor(0.0, 0.0, turning, 8.0)
    lab.drive(1257.0)
    feedthrough = np.array([[0.0, 0.0, 0.0], [0.0, -STIFFNESS, -8.0]])
    rules = (InputRule.MEAN, InputRule.START if turning else InputRule.MEAN, InputRule.MEAN)
    _, found, _ = inner_speeds(lab, feedthrough, rules, (-1, 2, -1))
    assert found == pytest.approx(0.0, abs=0.1)

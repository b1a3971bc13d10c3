"""What is refused at a point without a steady state, and what is said instead."""

import math

import pytest
from support.steady import STILL

import herringbone as hb
from herringbone.core import ParameterError


def test_an_open_set_point_takes_a_value():
    state = hb.steady("turbine", values=STILL, speed=100.0)
    assert state.mean("turbine.flange.w") == pytest.approx(100.0, rel=1e-9)


def test_speed_of_what_follows_its_loads_is_refused():
    with pytest.raises(ParameterError, match=r"speed: no part of .* declares a"):
        hb.steady("ship", values=STILL, speed=100.0)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"speed": 0.0}, "speed = 0 rad/s"),
        ({"speed": math.nan}, "speed = nan rad/s"),
        ({"torque": math.inf}, "torque = inf N m"),
    ],
)
def test_a_point_without_motion_is_refused(asked, said):
    with pytest.raises(ParameterError, match=said):
        hb.steady("test_rig", values=STILL, **asked)


def test_what_no_rotor_does_ends_without_a_state():
    state = hb.steady("test_rig", torque=1e9, values=STILL)
    assert not state.converged
    assert state.notes


def test_teeth_at_no_load_are_said_to_drift_apart():
    state = hb.steady("test_rig", values=STILL, torque=0.0, speed=100.0)
    assert not state.found
    assert "nothing holds the teeth together" in state.notes[-1]

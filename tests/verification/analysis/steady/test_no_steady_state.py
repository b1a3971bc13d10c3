"""What is refused at a point without a steady state, and what is said instead."""

import math
from pathlib import Path

import pytest
from support.steady import STILL

import herringbone as hb
from herringbone.core import ParameterError, StructureError

PAIR = Path(__file__).parents[4] / "system_models" / "ship" / "ship_pair.toml"


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


def test_a_period_of_many_meshes_at_a_slow_speed_is_said_to_be_too_long():
    """31 and 77 teeth meet again after 2387 meshes; a pinion at 1 rad/s makes 31 in 2 pi s."""
    told = hb.sweep("test_rig", gear=PAIR, speed=[1.0], torque=[100.0], workers=1).table
    assert told["outcome"].tolist() == ["not_converged"]
    assert told["message"][0].startswith(
        f"its period of 2387 meshes takes {77.0 * 2.0 * math.pi:.4g} s, longer than 100 s"
    )


@pytest.mark.parametrize(
    ("forgotten", "lacks"),
    [
        (
            '["gearbox.wheel", "thrust_coupling.flange_a"]',
            "thrust_coupling: nothing is joined to flange_a, which stands still",
        ),
        ('["propeller.flange_b", "water.flange"]', "water: nothing is connected to it"),
    ],
)
def test_a_forgotten_connection_is_named_first(tmp_path, forgotten, lacks):
    """The water's torque has an order of blades, and its shaft no longer turns with the diesel."""
    text = (PAIR.parent / "system.toml").read_text(encoding="utf-8")
    assert forgotten in text
    text = text.replace(f"  {forgotten},\n", "").replace("ship_pair.toml", PAIR.as_posix())
    (tmp_path / "system.toml").write_text(text, encoding="utf-8")
    with pytest.raises(StructureError) as error:
        hb.steady(tmp_path)
    said = str(error.value)
    assert said.startswith(lacks)
    assert said.endswith(
        "; water: it does not turn with the reference shaft, so that the motion does not repeat"
    )


def test_ripple_behind_a_freewheel_is_refused():
    """Its phase to the teeth is what it was before."""
    told = r"nothing holds booster\.angle at a phase to the rest, and torques depend on it"
    with pytest.raises(StructureError, match=told):
        hb.steady("boosted_axle", values={"booster_machine.order_1.amplitude": 3.0})

"""Speed and torque address what a system declares, and nothing else."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

from herringbone.analysis.set_points import addressed
from herringbone.core import ParameterError, StructureError
from herringbone.cosim.structure.system_file import read_system
from herringbone.running.operating.commanded import commanded, own_point

RPM = math.pi / 30.0


def test_a_controller_has_the_factors_of_its_constant_cycle():
    found = commanded(read_system("test_rig"), {"speed": 1500.0 * RPM, "torque": 300.0, "a.b": 1.0})
    assert found == {
        "a.b": 1.0,
        "bench_controller.speed_factor": pytest.approx(1.5, rel=1e-15),  # of 1000 r/min, 200 N m
        "bench_controller.torque_factor": pytest.approx(1.5, rel=1e-15),
    }


def test_inputs_that_nothing_feeds_are_set_points():
    found = commanded(read_system("turbine"), {"speed": 300.0 * RPM, "torque": 500.0})
    assert found == {"turbine.speed_setpoint": 300.0 * RPM, "generator.torque_setpoint": 500.0}


def test_free_flanges_take_them():
    found = commanded(read_system("gearbox"), {"speed": 300.0 * RPM, "torque": 500.0})
    assert found == {"gear_mesh.der(angle)": 300.0 * RPM, "gear_mesh.pinion.tau": 500.0}


@pytest.mark.parametrize(("system", "name"), [("e_axle", "speed"), ("back_to_back", "torque")])
def test_what_declares_none_is_refused(system, name):
    with pytest.raises(ParameterError, match=f"{name}: no part of {system} declares"):
        addressed(read_system(system), name)


def test_gears_beside_foreign_parts_have_a_speed_at_the_start():
    """No steady rotation decides on it; beside own parts one does, and nothing is promised."""
    axle = read_system("e_axle")
    with pytest.raises(ParameterError, match=r'values=\{"machine\.NAME": ...\}$'):
        addressed(axle, "speed")
    foreign = axle.with_fmu("machine", Path("Motor.fmu"))
    said = (
        r'the start is no equilibrium, values=\{"gearbox\.gear_mesh\.der\(angle\)": RAD_PER_S\} '
        "is the gears' speed, else 0$"
    )
    with pytest.raises(ParameterError, match=said):
        addressed(foreign, "speed")
    with pytest.raises(ParameterError, match=r'values=\{"road\.NAME": ...\}$'):
        addressed(foreign, "torque")


def test_several_are_refused():
    rig = read_system("test_rig")
    two = rig.without("bench_controller").with_values({})
    assert addressed(two, "torque") == "load_motor.torque_setpoint"
    pair = read_system("turbine").without("turbine_coupling")
    more = replace(pair, parts=(*pair.parts, replace(pair.part("turbine"), name="other")))
    with pytest.raises(StructureError, match=r"turbine\.speed_setpoint, other\.speed_setpoint"):
        addressed(more, "speed")


def test_a_cycle_that_moves_is_refused():
    rig = read_system("test_rig").with_values({"bench_controller.cycle": "runup.csv"})
    with pytest.raises(ParameterError, match=r"speed: bench_controller.*from 0 to 104\.72 rad/s"):
        commanded(rig, {"speed": 100.0})


@pytest.mark.parametrize(
    ("system", "speed", "torque"),
    [
        ("test_rig", {"bench_controller.speed_factor": 0.5}, {"bench_controller.torque_factor": 2}),
        ("gearbox", {"gear_mesh.der(angle)": 50.0}, {"gear_mesh.pinion.tau": 30.0}),
    ],
)
def test_the_point_of_a_system(system, speed, torque):
    """What commands is asked for the values that would give it."""
    known = read_system(system).with_values({**speed, **torque})
    found = own_point(known)
    assert commanded(known, {"speed": found[0]}) == pytest.approx(speed)
    assert commanded(known, {"torque": found[1]}) == pytest.approx(torque)


def test_nothing_tells_the_point_of_an_axle():
    assert own_point(read_system("e_axle")) == (None, None)

"""Checked access to an instance: the message for each kind of bad value."""

import math
from dataclasses import replace

import numpy as np
import pytest

from herringbone.components.bench_controller import BENCH_CONTROLLER
from herringbone.components.drive_motor import DRIVE_MOTOR
from herringbone.components.gear_mesh import GEAR_MESH
from herringbone.components.modal_housing import MODAL_HOUSING
from herringbone.core import Instance, ParameterError, ResourceError


@pytest.fixture
def motor() -> Instance:
    return Instance(DRIVE_MOTOR, "motor")


def message(instance: Instance, name: str, value) -> str:
    before = instance.memory.copy()
    with pytest.raises(ParameterError) as caught:
        instance.set(name, value)
    assert (instance.memory == before).all()  # a refused value changes nothing
    return str(caught.value)


def test_unknown_variable(motor):
    text = message(motor, "sped", 1.0)
    assert "motor: there is no variable 'sped'" in text
    assert "herringbone list drive_motor" in text


def test_reading_an_unknown_variable(motor):
    with pytest.raises(ParameterError, match=r"motor: there is no variable 'flange\.node1'"):
        motor["flange.node1"]


@pytest.mark.parametrize("value", ["fast", "1.0", True, False])
def test_wrong_type(motor, value):
    told = f"motor.speed = {value!r}: it takes a number alone, in rad/s"
    assert message(motor, "speed", value) == told


@pytest.mark.parametrize("value", [1.0, 3, True])
def test_wrong_type_of_a_file_name(value):
    gear = Instance(GEAR_MESH, "gear")
    text = message(gear, "stiffness_table", value)
    assert text == f"gear.stiffness_table = {value!r}: it takes a file name"


@pytest.mark.parametrize(
    ("name", "value", "expected"),
    [
        ("inertia", 0.0, "motor.inertia = 0 kg.m2: it must lie between 1e-09 and inf"),
        ("efficiency", 1.5, "motor.efficiency = 1.5: it must lie between 0.01 and 1"),
        ("torque_limit", -1.0, "motor.torque_limit = -1 N.m: it must lie between 0 and inf"),
        ("interface_degree", 5, "motor.interface_degree = 5: it must lie between 0 and 4"),
        ("interface_degree", -1, "motor.interface_degree = -1: it must lie between 0 and 4"),
        ("interface_degree", 1.5, "motor.interface_degree = 1.5: it must be a whole number"),
    ],
)
def test_out_of_range(motor, name, value, expected):
    assert message(motor, name, value) == expected


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("name", ["inertia", "speed", "flange.tau", "flange.tau.node2"])
def test_not_finite(motor, name, value):
    text = message(motor, name, value)
    assert f"motor.{name} = {value:g}" in text
    assert "it must be finite" in text


def test_what_is_computed_is_not_set(motor):
    """Of a run in one process nothing else would tell that the value is not used."""
    assert (
        message(motor, "flange.w", 50.0) == "motor.flange.w = 50.0: it is computed there, not set"
    )


def test_values_arrive_in_the_block(motor):
    for name, value in (("inertia", 0.5), ("speed", 3), ("flange.tau.node4", -2.0)):
        motor.set(name, value)
        assert motor[name] == value
        assert motor.block[motor.component.declaration.index[name]] == value


def test_start_values(motor):
    for variable in DRIVE_MOTOR.declaration.variables:
        assert motor[variable.name] == variable.start


def test_two_instances_share_nothing():
    first, second = Instance(DRIVE_MOTOR, "a"), Instance(DRIVE_MOTOR, "b")
    first.set("speed", 7.0)
    assert second["speed"] == 0.0


def test_initialise_checks_what_was_written_past_set(motor):
    motor.block[motor.component.declaration.index["inertia"]] = -1.0
    with pytest.raises(ParameterError, match=r"motor\.inertia = -1 kg\.m2: it must lie between"):
        motor.initialise()


def test_missing_resource_names_both_ways_out(tmp_path):
    gear = Instance(GEAR_MESH, "gear", resources=tmp_path)
    with pytest.raises(ResourceError) as caught:
        gear.initialise()
    text = str(caught.value)
    assert f"gear.stiffness_table = 'mesh_stiffness.csv': there is no file {tmp_path}" in text
    assert "give an absolute path or a name in" in text


def test_bad_resource_names_the_instance(tmp_path):
    for text in GEAR_MESH.declaration.texts:
        (tmp_path / text.start).write_text("nothing\n")
    gear = Instance(GEAR_MESH, "gear", resources=tmp_path)
    with pytest.raises(ResourceError, match=r"^gear: .*mesh_stiffness\.csv: the first line must"):
        gear.initialise()


@pytest.fixture
def counted():
    """The controller, and the files of each time that its cycle was read."""
    read = []

    def load(block, files):
        read.append(files)
        BENCH_CONTROLLER.load(block, files)

    return replace(BENCH_CONTROLLER, load=load), read


def cycle(file, speed):
    file.write_text(f"# units: time s, speed r/min, torque N.m\ntime,speed,torque\n0,{speed},5\n")


def tables(component, file):
    instance = Instance(component, "controller")
    instance.set("cycle", str(file))
    instance.initialise()
    return instance.block[component.declaration.first_table :]


def test_files_that_are_known_are_not_read_again(counted, tmp_path):
    """A copy of a file is known, too; what one instance does to its tables no other one sees."""
    component, read = counted
    for name in ("a", "b"):
        cycle(tmp_path / name, 1000.0)
    first = tables(component, tmp_path / "a")
    kept = first.copy()
    assert kept.any()
    first[:] = 7.0
    np.testing.assert_array_equal(tables(component, tmp_path / "b"), kept)
    assert len(read) == 1


def test_a_file_that_was_changed_is_read_again(counted, tmp_path):
    component, read = counted
    cycle(tmp_path / "a", 1000.0)
    before = tables(component, tmp_path / "a")
    cycle(tmp_path / "a", 1200.0)
    after = tables(component, tmp_path / "a")
    assert len(read) == 2
    assert np.count_nonzero(after != before) == 1
    np.testing.assert_array_equal(tables(BENCH_CONTROLLER, tmp_path / "a"), after)


def test_a_bad_file_is_refused_each_time(counted, tmp_path):
    component, read = counted
    (tmp_path / "a").write_text("nothing\n")
    for _ in range(2):
        with pytest.raises(ResourceError, match="the first line must"):
            tables(component, tmp_path / "a")
    assert len(read) == 2


def test_first_not_finite(motor):
    motor.initialise()
    assert motor.first_not_finite() is None
    motor.block[motor.component.declaration.index["flange.w"]] = math.nan
    name, value = motor.first_not_finite()
    assert name == "flange.w"
    assert math.isnan(value)


def test_first_not_finite_among_hidden_states():
    housing = Instance(MODAL_HOUSING, "housing")
    housing.initialise()
    housing.block[4] = math.inf
    assert housing.first_not_finite() == ("hidden state 5", math.inf)


def test_step_with_a_bad_input_reports_it(motor):
    motor.initialise()
    motor.block[motor.component.declaration.index["flange.tau"]] = math.nan
    assert motor.step(0.0, 1e-3) == 1
    assert motor.first_not_finite() is not None

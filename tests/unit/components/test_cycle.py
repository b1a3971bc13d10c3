"""Test cycles of the bench controller: interpolation, units, and messages for bad files."""

import math

import pytest

from herringbone.components.bench_controller import BENCH_CONTROLLER, ROWS
from herringbone.core import Instance, ResourceError

HEAD = "# units: time s, speed r/min, torque N.m\ntime,speed,torque\n"
CYCLE = HEAD + "1,0,0\n2,600,100\n4,1200,300\n"


@pytest.fixture
def controller(tmp_path):
    def make(text: str = CYCLE, **parameters: float) -> Instance:
        (tmp_path / "cycle.csv").write_text(text)
        instance = Instance(BENCH_CONTROLLER, "bench")
        instance.set("cycle", str(tmp_path / "cycle.csv"))
        for name, value in parameters.items():
            instance.set(name, value)
        instance.initialise()
        return instance

    return make


def at(instance: Instance, time: float) -> tuple[float, float]:
    assert instance.step(time, 0.0) == 0
    return instance["speed_setpoint"] * 30 / math.pi, instance["torque_setpoint"]


@pytest.mark.parametrize(
    ("time", "speed", "torque"),
    [
        (0, 0, 0),
        (1, 0, 0),
        (1.5, 300, 50),
        (2, 600, 100),
        (3, 900, 200),
        (4, 1200, 300),
        (9, 1200, 300),
    ],
)
def test_piecewise_linear_and_constant_outside(controller, time, speed, torque):
    # The default gear ratio of 3 turns pinion torque into load torque. Rounding only.
    assert at(controller(), time) == pytest.approx((speed, 3 * torque), rel=1e-14)


def test_speed_in_rad_per_second(controller):
    bench = controller(CYCLE.replace("r/min", "rad/s"))
    bench.step(2.0, 0.0)
    assert bench["speed_setpoint"] == 600.0


def test_factors_and_ratio(controller):
    bench = controller(gear_ratio=2.0, speed_factor=0.5, torque_factor=-1.5)
    assert at(bench, 2.0) == pytest.approx((300.0, -300.0), rel=1e-14)


def test_load_ramp(controller):
    bench = controller(load_ramp_time=8.0)
    assert at(bench, 4.0)[1] == pytest.approx(0.5 * 900.0, rel=1e-14)
    assert at(bench, 8.0)[1] == pytest.approx(900.0, rel=1e-14)
    assert at(bench, 9.0)[1] == pytest.approx(900.0, rel=1e-14)


def test_nodes_lie_inside_the_step(controller):
    bench = controller()
    bench.set("interface_degree", 4)
    bench.step(2.0, 2.0)
    nodes = [bench[f"torque_setpoint.node{n}"] for n in (1, 2, 3, 4)]
    assert nodes == pytest.approx([450.0, 600.0, 750.0, 900.0], rel=1e-14)
    assert bench["torque_setpoint"] == pytest.approx(900.0, rel=1e-14)


def test_breakpoints_are_the_kinks_and_the_end_of_the_ramp(controller):
    bench = controller(load_ramp_time=0.5)
    assert sorted(bench.component.breakpoints(bench.block)) == [0.5, 1.0, 2.0, 4.0]


BAD = [
    ("4,1200,300", "2,1200,300", "time does not rise from 2 s to 2 s"),
    ("4,1200,300", "1.5,1200,300", "time does not rise from 2 s to 1.5 s"),
    ("600", "fast", "line 4: speed = 'fast' is not a finite number"),
    ("600", "NaN", "line 4: speed = 'NaN' is not a finite number"),
    ("600,100", "600", "line 4: 2 fields, 3 expected"),
    (
        "speed r/min",
        "speed Hz",
        "column 'speed' has unit 'Hz' in the '# units:' line; it takes r/min or",
    ),
    ("torque N.m", "torque kN.m", "column 'torque' has unit 'kN.m'"),
    ("time,speed,torque", "time,speed,load", "column torque is missing"),
    (", torque N.m\ntime,speed,torque", "\ntime,speed,load", "column torque is missing"),
    ("# units", "units", "the first line must be '# units:"),
]


@pytest.mark.parametrize(("old", "new", "expected"), BAD)
def test_bad_cycle(controller, old, new, expected):
    assert old in CYCLE
    with pytest.raises(ResourceError) as caught:
        controller(CYCLE.replace(old, new))
    assert expected in str(caught.value)
    assert str(caught.value).startswith("bench: ")
    assert "cycle.csv" in str(caught.value)


def test_no_rows(controller):
    with pytest.raises(ResourceError, match=r"cycle\.csv: it has no rows"):
        controller(HEAD)


def test_most_rows(controller):
    rows = [f"{i},{i},0" for i in range(ROWS + 1)]
    assert at(controller(HEAD + "\n".join(rows[:ROWS])), 254.5)[0] == pytest.approx(
        254.5, rel=1e-14
    )
    with pytest.raises(ResourceError, match=f"{ROWS + 1} rows; at most {ROWS}"):
        controller(HEAD + "\n".join(rows))


def test_missing_file_names_instance_variable_and_folder(tmp_path):
    bench = Instance(BENCH_CONTROLLER, "bench", resources=tmp_path)
    bench.set("cycle", "nowhere.csv")
    with pytest.raises(ResourceError) as caught:
        bench.initialise()
    assert "bench.cycle = 'nowhere.csv': there is no file" in str(caught.value)
    assert f"give an absolute path or a name in {tmp_path}" in str(caught.value)

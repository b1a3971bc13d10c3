"""Where no start in equilibrium is known, what drives foreign parts rises from zero."""

import numpy as np
import pytest
from support.foreign.c_flange import SOURCE, c_flange, description
from support.foreign.fmi3_description import c_part
from support.foreign.strangers import write_system

import herringbone as hb
from herringbone.cosim.structure.system_file import read_system
from herringbone.running import start
from herringbone.running.gradual.fitted import fitted_ramp
from herringbone.running.gradual.raised import raised, together
from herringbone.running.settling.stranger import NeverSettlesError
from herringbone.scenes import Scene, Start

STEP, TORQUE = 4e-5, 150.0
INERTIA, STIFFNESS = 0.15, 4e4  # of c_flange.c
ROTOR, DRUM, SOFT = 0.3, 2.0, 2e3
OWN = f"""
rotor = {{ component = "rotating_inertia", set = {{ inertia = {ROTOR} }} }}
soft = {{ component = "shaft_coupling", set = {{ stiffness = {SOFT}, damping = 0.5 }} }}
drum = {{ component = "rotating_inertia", set = {{ inertia = {DRUM} }} }}
"""
JOINED = [
    ["motor.flange", "rotor.flange_a"],
    ["rotor.flange_b", "soft.flange_a"],
    ["soft.flange_b", "drum.flange_a"],
]


def driven(folder, fmu):
    path = write_system(folder, "driven", JOINED, {"motor": fmu})
    with (path / "system.toml").open("a", encoding="utf-8") as opened:
        opened.write(OWN)
    return path


@pytest.fixture(scope="module")
def system(tmp_path_factory):
    """A foreign rotor behind its shaft, a rotor, and a drum on a soft one."""
    folder = tmp_path_factory.mktemp("driven")
    return driven(folder, c_flange(folder, "SHAFT"))


def slowest():
    """Hz: of three bodies in a row, without damping."""
    k = np.zeros((3, 3))
    for a, b, stiffness in ((0, 1, STIFFNESS), (1, 2, SOFT)):
        k[[a, b], [a, b]] += stiffness
        k[[a, b], [b, a]] -= stiffness
    squares = np.linalg.eigvals(np.diag(1.0 / np.array([INERTIA, ROTOR, DRUM])) @ k)
    return np.sqrt(np.sort(squares.real)[1]) / (2.0 * np.pi)


def test_an_input_that_drives_rises(system):
    found = raised(read_system(system).with_values({"motor.drive": TORQUE}), STEP)
    assert found.inputs == ("motor.drive",) and found.lines == ()
    part = found.system.part("motor_drive_rising")
    assert part.values["final_value"] == TORQUE
    assert ("motor_drive_rising.torque", "motor.drive") in found.system.connections


@pytest.mark.parametrize("brake", [-60.0, 60.0])
def test_torques_that_drive_together_rise(tmp_path, brake):
    more = (
        '<ScalarVariable name="brake" valueReference="3" causality="input">'
        '<Real unit="N.m" start="0"/></ScalarVariable>'
    )
    text = description("SHAFT").replace("</ModelVariables>", f"{more}</ModelVariables>")
    fmu = c_part(SOURCE, text, tmp_path, ("PART=SHAFT",), fmi=2)
    values = {"motor.drive": TORQUE, "motor.brake": brake}
    found = raised(read_system(driven(tmp_path, fmu)).with_values(values), STEP)
    assert found.inputs == ("motor.drive", "motor.brake") and found.lines == ()
    assert found.system.part("motor_brake_rising").values["final_value"] == brake


@pytest.mark.parametrize(
    ("needed", "found"), [("bd", "bd"), ("abcd", "abcd"), ("e", ""), ("be", "")]
)
def test_fewest_inputs_without_which_a_part_gives_nothing(needed, found):
    assert "".join(together("abcd", lambda tried: set(needed) <= set(tried))) == found


def test_nothing_rises_where_nothing_drives(system):
    plain = read_system(system)
    assert raised(plain, STEP) == (plain, (), ())


def test_a_parameter_cannot_rise(tmp_path):
    text = description("SHAFT").replace(
        'name="drive" valueReference="2" causality="input"',
        'name="drive" valueReference="2" causality="parameter" variability="tunable"',
    )
    fmu = c_part(SOURCE, text, tmp_path, ("PART=SHAFT",), fmi=2)
    found = raised(read_system(driven(tmp_path, fmu)).with_values({"motor.drive": TORQUE}), STEP)
    assert found.inputs == ()
    (line,) = found.lines
    assert line.startswith("motor.drive acts from the start: it is a parameter, and cannot rise")


def test_a_unit_that_nothing_gives(tmp_path):
    fmu = c_flange(tmp_path, "SHAFT", units={"drive": "m"})
    found = raised(read_system(driven(tmp_path, fmu)).with_values({"motor.drive": TORQUE}), STEP)
    assert found.inputs == ()
    assert "nothing here gives a value in m that rises" in found.lines[0]


def test_ramp_is_a_period_of_the_slowest_oscillation(system):
    """Of the whole drivetrain, 11.7 Hz; own parts alone would swing at 13.9 Hz."""
    ramp = fitted_ramp(read_system(system), 10.0, STEP)
    assert 1.0 / ramp.time == pytest.approx(slowest(), rel=1e-3)
    assert ramp.why == f"the slowest oscillation is at {slowest():.3g} Hz"
    short = fitted_ramp(read_system(system), 0.1, STEP)
    assert short.time == 0.05 and "half of the run is less than a period" in short.why


def test_a_run_that_has_no_equilibrium_begins_without_torque(system, monkeypatch):
    def never(*_):
        raise NeverSettlesError("motor.flange.tau does not die out")

    monkeypatch.setattr(start, "loaded_settled_start", never)
    scene = Scene("s", t_end=2.0, values={"motor.drive": TORQUE})
    found, notes = start.started(read_system(system), scene, STEP)
    time = found.part("motor_drive_rising").values["load_ramp_time"]
    assert 1.0 / time == pytest.approx(slowest(), rel=1e-3)
    assert f"motor.drive rises from zero over {time:.3g} s instead, as the slowest" in notes[0]
    at_rest, _ = start.started(read_system(system), Scene("s", start=Start.REST), STEP)
    assert len(at_rest.parts) == len(read_system(system).parts)


def test_what_it_swings_by(system, monkeypatch):
    """A linear ramp over a period T leaves nothing of an undamped oscillation, a jump all of it."""
    monkeypatch.setattr(start, "LOAD_RAMP_TIME", 1.0 / slowest())
    options = {"values": {"motor.drive": TORQUE}, "t_end": 0.5, "step": 1e-4, "record_step": 1e-3}
    swings = {}
    for begin in ("rest", "ramp"):
        data = hb.run(system, start=begin, **options).data
        twist = data["soft.flange_a.tau"].to_numpy()
        late = twist[data.index.size // 2 :]
        swings[begin] = np.ptp(late)
    assert data["motor_drive_rising.torque"].iloc[-1] == TORQUE
    assert swings["ramp"] < 0.02 * swings["rest"]

"""Starts in equilibrium beside FMUs that take steps of one length only: stepped as in the run."""

import zipfile
from pathlib import Path

import numpy as np
import pytest
from pythonfmu.builder import FmuBuilder
from support.foreign.c_housing import c_housing_fmu
from support.foreign.strangers import write_system

import herringbone as hb
from herringbone.running.prepared import Wishes, prepared

INERTIA, STIFFNESS = 0.12, 8e4
TORQUE, SPEED, STEP = 205.0, 80.0, 2e-5
JOINED = [
    ["motor.flange", "gearbox.pinion"],
    ["gearbox.wheel", "coupling.flange_a"],
    ["load.flange", "coupling.flange_b"],
    ["bench.torque_setpoint", "load.torque_setpoint"],
]
OWN = """
gearbox = { system = "gearbox" }
coupling = { component = "shaft_coupling", set = { stiffness = 3e5, damping = 50.0 } }
load = { component = "load_motor" }
bench = { component = "bench_controller" }
"""


@pytest.fixture(scope="module", params=[False, True], ids=["once", "saves"])
def system(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("even")
    source = Path(__file__).parents[3] / "fmus" / "even_drive.py"
    abilities = {"canGetAndSetFMUstate": request.param, "canSerializeFMUstate": request.param}
    FmuBuilder.build_FMU(
        source, dest=folder, canHandleVariableCommunicationStepSize=False, **abilities
    )
    found = write_system(folder, "even", JOINED, {"motor": folder / "EvenDrive.fmu"})
    with (found / "system.toml").open("a", encoding="utf-8") as opened:
        opened.write(OWN)
    return found


@pytest.mark.parametrize("step", [STEP, 1.3 * STEP])
def test_nothing_jumps(system, step):
    """The angle that is held over a step lets the shaft give k w H / 2 more at its end.

    1.3 of the step is shortened, so that a whole number of steps makes the run: an FMU that was
    stepped otherwise before the run would refuse its first step. With a ramp the torque swings by
    eight times its size.
    """
    values = {"motor.torque_set": TORQUE, "gear_mesh.der(angle)": SPEED}
    run = hb.run(system, values=values, t_end=0.01, step=step, record_step=step)
    assert run.outcome.ended_well
    line = next(note for note in run.info.notes if "speeds up by" in note)
    acceleration = float(line.partition("speeds up by ")[2].split()[0])
    time, torque = (run.data[name].to_numpy() for name in ("time", "motor.flange.tau"))
    more = 0.5 * STIFFNESS * time[1]
    # Answers are steady within 5e-4 at the step that was asked for, which is up to 0.2 % longer.
    expected = TORQUE - INERTIA * acceleration + more * SPEED
    assert torque[0] == pytest.approx(expected, abs=1e-3 * TORQUE + 2e-3 * more * SPEED)
    # As with steps of any length, of what the mesh excites; the shaft speeds up meanwhile.
    later = torque - torque[0] - more * acceleration * time
    assert np.abs(later).max() < 0.01 * TORQUE
    (told,) = (note for note in run.info.notes if "stepped over" in note)
    assert told.endswith(f"in steps of {step:g} s, as in the run, on inputs that are held")


def test_housing_starts_as_with_steps_of_any_length(tmp_path):
    """Forces stand still: what is held over a step changes nothing.

    What a housing that still moves by 5e-4 of its deflection leaves, in either of both.
    """
    free = c_housing_fmu(tmp_path)
    even = tmp_path / "c_housing_even.fmu"
    with zipfile.ZipFile(free) as whole, zipfile.ZipFile(even, "w") as copy:
        for name in whole.namelist():
            data = whole.read(name).replace(b'StepSize="true"', b'StepSize="false"')
            copy.writestr(name, data)
    found = []
    for file in (free, even):
        wishes = Wishes(replace_parts={"modal_housing": file})
        started = prepared("test_rig", None, wishes, trial_step=STEP).system
        way = started.part("modal_housing").approach
        assert way is not None and way.even is (file is even)
        found.append(started.part("gear_mesh").values)
    for name, value in found[0].items():
        size = max(abs(value), 1e-6 if not name.startswith("der(") else 1e-3)
        assert found[1][name] == pytest.approx(value, abs=1e-3 * size), name

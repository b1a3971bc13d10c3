"""Starts beside a motor whose torque pulsates as it turns: those of the same motor without."""

import re
from pathlib import Path

import numpy as np
import pytest
from pythonfmu.builder import FmuBuilder
from support.foreign.strangers import write_system

from herringbone.running.prepared import Wishes, prepared

STEP, TORQUE, INERTIA = 4e-5, 120.0, 0.12
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


@pytest.fixture(scope="module")
def system(tmp_path_factory):
    folder = tmp_path_factory.mktemp("ripple")
    source = Path(__file__).parents[3] / "fmus" / "ripple_drive.py"
    FmuBuilder.build_FMU(source, dest=folder)
    found = write_system(folder, "pulsating", JOINED, {"motor": folder / "RippleDrive.fmu"})
    with (found / "system.toml").open("a", encoding="utf-8") as opened:
        opened.write(OWN)
    return found


def started(system, speed, **values):
    """Acceleration of the start in rad/s^2, and what lines say of pulsation."""
    given = {"motor.torque_set": TORQUE, "gear_mesh.der(angle)": speed}
    given |= {f"motor.{name}": value for name, value in values.items()}
    notes = prepared(system, None, Wishes(values=given), trial_step=STEP).notes
    line = next(note for note in notes if "speeds up by" in note)
    pulsates = [note for note in notes if "pulsates by" in note]
    return float(line.partition("speeds up by ")[2].split()[0]), pulsates


@pytest.mark.parametrize(("speed", "order"), [(90.0, 6.0), (25.0, 18.0)])
def test_the_mean_starts_as_a_motor_without_ripple(system, speed, order):
    """Torque over the inertia of the drivetrain, which the motor alone is a part of.

    Answers are steady within 5e-4. While the shaft speeds up by a, ripple of an amplitude takes
    longer for the first half of a period p than for the last, by p a / speed^2.
    """
    steady, none = started(system, speed, ripple=0.0, cogging=0.0)
    found, (line,) = started(system, speed, order=order)
    assert not none
    swing = float(re.search(r"by \+-(\S+) as its shaft turns", line).group(1))
    assert swing > 2.0
    uneven = 2.0 * np.pi / 6.0 * abs(steady) / speed**2
    assert found == pytest.approx(steady, abs=(5e-4 * TORQUE + 0.5 * uneven * swing) / INERTIA)
    assert abs(found - steady) < 0.01 * abs(steady)

"""Scenes of the test rig, and its gearbox alone."""

import numpy as np
import pytest
from support.parts.running import columns, run_in_process
from support.rig.in_process import (
    BASE_RADIUS,
    BEARING,
    BEARING_Y,
    MESH,
    PINION_TORQUE,
    SPEED,
    SPEEDS,
    TORQUES,
    errors,
    rig,
    select,
    twin,
)

from herringbone.analysis.accuracy.error import relative_error
from herringbone.analysis.equilibrium import equilibrium
from herringbone.analysis.twin.monolithic import Twin
from herringbone.cosim.algorithms import Jacobi
from herringbone.cosim.structure.system_file import read_system


def test_separation_separates():
    _, table = twin("separation", 0.02)
    forces = select(table, MESH)
    share = (forces == 0.0).mean(axis=0)
    print(f"share of time without contact: left {share[0]:.2%}, right {share[1]:.2%}")  # noqa: T201
    assert forces.min() == 0.0
    assert ((share > 0.01) & (share < 0.2)).all()
    assert forces[-100:].min() > 0.0  # contact again
    assert errors(Jacobi(order=2), [5e-6], "separation").max() < 1e-3


def test_runup_ends_at_speed():
    recording = run_in_process(rig("runup"), Jacobi(order=2), 1e-5, 0.6, record=1e-4)
    speed = columns(recording, SPEEDS)[:, 0] * 30.0 / np.pi
    torque = columns(recording, TORQUES)[:, 0]
    assert speed[0] == 0.0 and torque[0] == 0.0
    at = dict(zip(np.round(recording.time, 6).tolist(), speed.tolist(), strict=True))
    assert at[0.1] == pytest.approx(500.0, rel=0.1)
    assert at[0.3] == pytest.approx(1000.0, rel=0.02)  # the controller's overshoot decays
    assert at[0.6] == pytest.approx(1000.0, rel=5e-4)
    assert speed.max() < 1100.0
    assert torque[-1000:].mean() == pytest.approx(PINION_TORQUE, rel=2e-3)


def alone(names):
    """Columns of the rig's gearbox as they are called in the gearbox alone."""
    return [name.removeprefix("gearbox.") for name in names]


@pytest.mark.parametrize("speed", [0.0, SPEED])
def test_gearbox_alone(speed):
    """Torques that nothing feeds act through the whole macro step."""
    system = read_system("gearbox").with_values(
        {
            "gear_mesh.pinion.tau": PINION_TORQUE,
            "gear_mesh.wheel.tau": -3.0 * PINION_TORQUE,
            "gear_mesh.der(angle)": speed,
        }
    )
    found = equilibrium(system)
    assert found.residual < 1e-10
    system = system.with_values(found.values)
    recording = run_in_process(system, Jacobi(order=2), 1e-5, 0.02, record=20e-6)
    assert recording.outcome.completed
    forces = columns(recording, alone(BEARING_Y))
    wanted = PINION_TORQUE / BASE_RADIUS
    assert forces[0, :2].sum() == pytest.approx(wanted, rel=1e-5)
    assert forces[:, :2].sum(axis=1).mean() == pytest.approx(wanted, rel=1e-3)
    assert forces[:, 2:].sum(axis=1).mean() == pytest.approx(-wanted, rel=1e-3)
    assert columns(recording, alone(SPEEDS))[-1] == pytest.approx(
        [speed, speed / 3.0], rel=1e-3, abs=1e-6
    )
    if speed:
        reference = Twin(system).solve(recording.time, alone(BEARING))
        assert relative_error(columns(recording, alone(BEARING)), reference) < 3e-3


def test_equilibrium_without_rotation_stays():
    """At rest nothing excites: the forces do not move at all."""
    system = read_system("gearbox").with_values(
        {"gear_mesh.pinion.tau": PINION_TORQUE, "gear_mesh.wheel.tau": -3.0 * PINION_TORQUE}
    )
    system = system.with_values(equilibrium(system).values)
    forces = columns(run_in_process(system, Jacobi(order=2), 1e-5, 0.02), alone(BEARING_Y))
    assert np.abs(forces - forces[0]).max() < 1e-6 * np.abs(forces[0]).max()

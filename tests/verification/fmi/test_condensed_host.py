"""The gearbox for hosts by its condensed core; Runge-Kutta at a hundredth of the tolerance."""

import random
from itertools import cycle

import numpy as np
import pytest
from fuzz.campaign import last_commit
from support.compiler import needs_compiler
from support.hosts.fmi2 import Fmi2Host
from support.hosts.fmi3 import Fmi3Host

from herringbone.core.declaring.hosting import Wanted
from herringbone.running.exporting.system_fmu import export_fmu

RATIO, SPEED, TOLERANCE = 3.0, 1000.0 * np.pi / 30.0, 1e-3
CHANCE = random.Random(last_commit())
DRAWN = [(CHANCE.uniform(0.1, 3.5), CHANCE.uniform(-900.0, 900.0)) for _ in range(2)]
"""Speed [1000 r/min] and torque [N m]."""
BEARING = "bearing_supports.pinion.radial_stiffness"
STEPS = (1e-3, 3.7e-4, 4.1e-5, 1e-6, 2.5e-3)

pytestmark = [pytest.mark.slow, needs_compiler]


@pytest.fixture(scope="module")
def gearbox(tmp_path_factory):
    return export_fmu("gearbox", tmp_path_factory.mktemp("core") / "g.fmu", wanted=Wanted())


def load(speed, torque):
    speed *= SPEED
    return {"initial_speed": speed, "pinion.tau": torque, "wheel.tau": -RATIO * torque}


def run(host, steps, count, start=0.0, slope=0.0):
    """Bearing forces after so many steps of alternating lengths; the torque's slope [N m/s]."""
    names = [n for n in host.reference if n.startswith("bearing.")]
    rows, t, tau = [], start, host.get("pinion.tau")[0]
    for _, h in zip(range(count), cycle(steps), strict=False):
        if slope:
            host.set({"pinion.tau": tau + slope * (t - start)})
            host.slave.setRealInputDerivatives([host.reference["pinion.tau"]], [1], [slope])
        host.step(t, h)
        t += h
        rows.append(host.get(*names))
    return np.array(rows)


def error(file, folder, values, steps=(1e-3,), count=60, slope=0.0):
    """Of all bearing forces, over their alternating part."""
    found, exact = (
        run(Fmi2Host(file, folder / str(t), 0.0, t, values), steps, count, slope=slope)
        for t in (TOLERANCE, 0.01 * TOLERANCE)
    )
    return np.linalg.norm(found - exact) / np.linalg.norm(exact - exact.mean(axis=0))


@pytest.mark.parametrize(("speed", "torque"), [(1.0, 200.0), (3.0, 900.0), (1.0, -200.0), *DRAWN])
def test_error_at_operating_points(speed, torque, gearbox, tmp_path):
    """At a hundredth of the tolerance all steps are those of Runge-Kutta."""
    assert error(gearbox, tmp_path, load(speed, torque)) < 2.0 * TOLERANCE


def test_steps_of_any_length(gearbox, tmp_path):
    assert error(gearbox, tmp_path, load(1.0, 200.0), STEPS) < 2.0 * TOLERANCE


def test_torque_along_its_derivative(gearbox, tmp_path):
    assert error(gearbox, tmp_path, load(1.0, 200.0), slope=500.0) < 2.0 * TOLERANCE


@pytest.mark.parametrize("change", [{BEARING: 1e8}, {"gear_mesh.mesh_damping_ratio": 0.2}])
def test_changed_parameters(change, gearbox, tmp_path):
    values = load(1.0, 200.0) | change
    assert error(gearbox, tmp_path, values) < 2.0 * TOLERANCE


def test_teeth_that_separate(gearbox, tmp_path):
    """No torque after a load: teeth rattle, which few digits survive for long."""
    values = load(1.0, 200.0) | {"start_mode": 1}
    rows = []
    for t in (TOLERANCE, 0.01 * TOLERANCE):
        host = Fmi2Host(gearbox, tmp_path / str(t), 0.0, t, values)
        host.set({"pinion.tau": 0.0, "wheel.tau": 0.0})
        rows.append(run(host, (1e-4,), 40))
    found, exact = rows
    assert np.linalg.norm(found - exact) < 5.0 * TOLERANCE * np.linalg.norm(exact)


def test_same_bits_as_fresh(gearbox, tmp_path):
    """Restored, in another instance too, reset, and started later: 2^-10 s are exact."""
    values, steps = load(1.0, 200.0), (2.0**-10, 2.0**-12)
    host = Fmi2Host(gearbox, tmp_path / "a", values=values)
    run(host, steps, 5)
    state = host.slave.getFMUState()
    data = host.slave.serializeFMUState(state)
    expected = run(host, steps, 20)
    host.slave.setFMUState(state)
    assert run(host, steps, 20).tobytes() == expected.tobytes()
    other = Fmi2Host(gearbox, tmp_path / "b", values=load(2.0, -50.0) | {BEARING: 1e8})
    other.slave.setFMUState(other.slave.deserializeFMUState(data))
    assert run(other, steps, 20).tobytes() == expected.tobytes()
    first = run(Fmi2Host(gearbox, tmp_path / "c", values=values), steps, 20)
    host.slave.reset()
    host.initialise(values=values)
    assert run(host, steps, 20).tobytes() == first.tobytes()
    later = Fmi2Host(gearbox, tmp_path / "d", start=8.0, values=values)
    assert run(later, steps, 20, start=8.0).tobytes() == first.tobytes()


def test_fmi_3_has_the_same_core(gearbox, tmp_path):
    """Same bits as in FMI 2, whose error is known, where torques change from step to step."""
    third = export_fmu("gearbox", tmp_path / "g3.fmu", fmi=3, wanted=Wanted())
    values = load(1.0, 200.0)
    rows = []
    for host in (
        Fmi2Host(gearbox, tmp_path / "2", values=values),
        Fmi3Host(third, tmp_path / "3", None, values),
    ):
        names = [n for n in host.reference if n.startswith("bearing.")]
        found, t = [], 0.0
        for k, h in zip(range(60), cycle(STEPS), strict=False):
            host.set({"pinion.tau": 200.0 + 20.0 * (k % 3)})
            host.step(t, h)
            t += h
            found.append([float(host.get(n)[0]) for n in names])
        rows.append(np.array(found))
    assert rows[1].tobytes() == rows[0].tobytes()

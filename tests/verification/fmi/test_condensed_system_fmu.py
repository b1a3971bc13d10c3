"""A whole system as one native FMU, by its condensed core: the bits of its kernels in Python."""

import re
from itertools import cycle

import numpy as np
import pytest
from fmpy import read_model_description
from fmpy.fmi1 import FMICallException
from support.compiler import needs_compiler
from support.hosts.fmi2 import Fmi2Host
from support.rig.as_one import instance_of, rig_as_one

from herringbone.running.exporting.system_fmu import export_fmu

STIFFNESS = "gearbox.bearing_supports.pinion.radial_stiffness"
HELIX = "gearbox.gear_mesh.base_helix_angle"
CLEARANCE = "gearbox.bearing_supports.pinion.radial_clearance"
STEPS = (3.7e-4, 4.1e-5, 1e-6, 1e-3, 2.3e-4)

pytestmark = [pytest.mark.slow, needs_compiler]


@pytest.fixture(scope="module")
def rig(tmp_path_factory):
    return export_fmu("test_rig", tmp_path_factory.mktemp("rig") / "rig.fmu", scene="loaded")


def run(host, count, names, time=0.0):
    rows = []
    for _, h in zip(range(count), cycle(STEPS), strict=False):
        host.step(time, h)
        time += h
        rows.append(host.get(*names))
    return np.array(rows)


def test_native_bits_are_those_of_python(rig, tmp_path):
    """With steps of any length, a tolerance, and parameters that are not those of the export."""
    composite = rig_as_one()
    python = instance_of(composite, tmp_path, "rig")
    d = composite.component.declaration
    python.set(STIFFNESS, 1e8)
    python.initialise()
    python.block[d.index["tolerance"]] = 3e-4
    python.step(0.0, 0.0)
    host = Fmi2Host(rig, tmp_path / "fmu", tolerance=3e-4, values={STIFFNESS: 1e8})
    names, time = [v.name for v in d.outputs], 0.0
    for _, h in zip(range(15), cycle(STEPS), strict=False):
        host.step(time, h)
        assert python.step(time, h) == 0
        time += h
        assert host.get(*names).tobytes() == python.block[[d.index[n] for n in names]].tobytes()
    assert host.messages == [] or not any("Runge-Kutta" in m for m in host.messages)


def test_same_bits_from_a_state(rig, tmp_path):
    """Restored, and in another instance that was elsewhere, serialised."""
    host = Fmi2Host(rig, tmp_path / "a")
    names = [n for n in host.reference if n.endswith((".f_y", ".f_z", ".v_x", ".a_y"))]
    run(host, 7, names)
    state = host.slave.getFMUState()
    data = host.slave.serializeFMUState(state)
    expected = run(host, 12, names, 0.01)
    host.slave.setFMUState(state)
    assert run(host, 12, names, 0.01).tobytes() == expected.tobytes()
    other = Fmi2Host(rig, tmp_path / "b", values={STIFFNESS: 1e8})
    run(other, 3, names)
    other.slave.setFMUState(other.slave.deserializeFMUState(data))
    assert run(other, 12, names, 0.01).tobytes() == expected.tobytes()


def test_what_has_no_condensed_form_is_told(rig, tmp_path):
    host = Fmi2Host(rig, tmp_path, values={CLEARANCE: 20e-6})
    host.step(0.0, 1e-4)
    (line,) = [m for m in host.messages if "Runge-Kutta alone" in m]
    assert "the equations have no condensed form" in line


@pytest.mark.parametrize(("tolerance", "told"), [(1e-5, 0), (1e-6, 1)])
def test_parameters_of_another_pair_are_told(tolerance, told, rig, tmp_path):
    """A helix that differs by 5e-5 is that of the table yet; ten times the tolerance is the limit.

    Before the first step, as the host sets it before.
    """
    starts = {v.name: v.start for v in read_model_description(str(rig)).modelVariables}
    helix = float(starts[HELIX])
    host = Fmi2Host(rig, tmp_path, tolerance=tolerance, values={HELIX: helix * (1.0 + 5e-5)})
    lines = [m for m in host.messages if "parameters are not those at export" in m]
    assert len(lines) == told
    assert all("helix of a gear pair" in line for line in lines)


def names_of(rig):
    """Outputs with their first nodes, states, inputs and parameters."""
    reals = [v.name for v in read_model_description(str(rig)).modelVariables if v.type == "Real"]
    return [n for n in reals if ".node" not in n or n.endswith(".node1")]


def stepped(rig, folder, count, reading=()):
    """A host that has taken some steps of 0.1 ms, and has read some variables after each."""
    host = Fmi2Host(rig, folder)
    for k in range(count):
        host.step(k * 1e-4, 1e-4)
        if reading:
            host.get(*reading)
    return host


SOME = ("gearbox.bearing_supports.shaft.pinion_left.f_y", "gearbox.modal_housing.wheel_left.v_x")
BENT = ("load_motor.loss_power", "gearbox.gear_mesh.transmission_error")


def test_bits_do_not_depend_on_what_was_read_before(rig, tmp_path):
    """Outputs that are affine and others, states; one after the other, or together."""
    hosts = [stepped(rig, tmp_path / "all", 7, names_of(rig))]
    hosts += [stepped(rig, tmp_path / str(k), 7, r) for k, r in enumerate(((), SOME, BENT))]
    names = names_of(rig)
    expected = hosts[0].get(*names)
    for host in hosts[1:3]:
        assert host.get(*names).tobytes() == expected.tobytes()
    one_by_one = np.array([hosts[3].get(name)[0] for name in reversed(names)])[::-1]
    assert one_by_one.tobytes() == expected.tobytes()


def test_what_was_not_read_is_in_a_state(rig, tmp_path):
    """Also where another instance takes it, which was asked for other things, or for nothing."""
    host = stepped(rig, tmp_path / "a", 5, SOME)
    state = host.slave.getFMUState()
    data = host.slave.serializeFMUState(state)
    names = names_of(rig)
    expected = host.get(*names)
    host.step(5e-4, 1e-4)
    host.slave.setFMUState(state)
    assert host.get(*names).tobytes() == expected.tobytes()
    for folder, others in (("b", BENT), ("c", ())):
        other = stepped(rig, tmp_path / folder, 3, others)
        other.slave.setFMUState(other.slave.deserializeFMUState(data))
        assert other.get(*SOME).tobytes() == host.get(*SOME).tobytes()
        assert other.get(*names).tobytes() == expected.tobytes()
    fresh = Fmi2Host(rig, tmp_path / "d")
    fresh.slave.setFMUState(fresh.slave.deserializeFMUState(data))
    assert fresh.get(*names).tobytes() == expected.tobytes()


def test_a_parameter_does_not_change_what_was_not_read(rig, tmp_path):
    """Outputs are those of the last step; `interface_degree` can be changed at any time."""
    hosts = [stepped(rig, tmp_path / name, 4) for name in "ab"]
    hosts[1].set({"interface_degree": 2.0})
    names = [n for n in names_of(rig) if n != "interface_degree"]
    assert hosts[1].get(*names).tobytes() == hosts[0].get(*names).tobytes()


def test_derivatives_see_what_was_not_read(rig, tmp_path):
    """Those of outputs, also over the step before, and directional ones."""
    names = names_of(rig)
    hosts = [stepped(rig, tmp_path / str(k), 6, r) for k, r in enumerate((names, ()))]
    found = []
    for host in hosts:
        chosen = [host.reference[n] for n in (*SOME, *BENT)]
        speed = host.reference["der(gearbox.gear_mesh.angle)"]
        slopes = host.slave.getDirectionalDerivative(chosen, [speed], [1.0])
        rates = host.slave.getRealOutputDerivatives(chosen, [1] * len(chosen))
        found.append((rates, list(slopes), host.get(*names).tobytes()))
    assert found[0] == found[1]


def test_a_micro_step_beyond_its_limit_is_named(rig, tmp_path):
    """Before and after it fails; a shorter one than the limit that is told is stable."""
    host = Fmi2Host(rig, tmp_path / "a", values={"micro_step": 5e-5})
    (line,) = [m for m in host.messages if "micro_step = 5e-05 s" in m]
    limit = float(re.search(r"stable up to some ([\d.e-]+) s", line)[1])
    with pytest.raises(FMICallException):
        run(host, 40, SOME)
    assert "fails, whose cause is micro_step = 5e-05 s" in host.messages[-1]
    assert "communication step" not in host.messages[-1]
    steady = Fmi2Host(rig, tmp_path / "b", values={"micro_step": 0.95 * limit})
    assert np.abs(run(steady, 40, SOME)).max() < 1e4
    assert not any("micro_step = " in m for m in steady.messages)


def test_a_parameter_that_the_start_does_not_suit_is_told(rig, tmp_path):
    """By its name, but not where it is a matter of integration or the host gives a state."""
    given = {STIFFNESS: 1e8, "drive_motor.speed": 100.0}
    cases = ({}, {"micro_step": 1e-6}, given, {STIFFNESS: 1e8})
    told = []
    for number, values in enumerate(cases):
        host = Fmi2Host(rig, tmp_path / str(number), values=values)
        told.append([m for m in host.messages if "the states start as this FMU was made" in m])
    *silent, (line,) = told
    assert silent == [[], [], []]
    assert f"{STIFFNESS} is set to 1e+08, but" in line

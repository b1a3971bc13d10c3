"""What a step that fails leaves, where steps end, and what is computed at their end."""

import math

import pytest
from fmpy.fmi1 import FMICallException
from support.fmus import H, outputs
from support.hosts.fmi2 import Fmi2Host
from support.hosts.fmi3 import Fmi3Host

from herringbone.components.registry import COMPONENTS

SLOPE = 1e5


@pytest.mark.parametrize("name", ["gear_mesh", "bearing_supports"])
def test_failed_step_leaves_everything_as_it_was(name, started):
    """Also of what runs on, so that the step that is taken instead has the same bits."""
    given = COMPONENTS[name].declaration.inputs[0].name
    failed, plain = started(name), started(name, "other")
    for host in (failed, plain):
        host.set_values({given: 1e-4})
        host.step(0.0, H)
    before = failed.values(*outputs(name))
    failed.set_values({given: 1e300})
    with pytest.raises(FMICallException):
        failed.slave.doStep(H, 1e3 * H)
    assert failed.values(*outputs(name)) == before
    for host in (failed, plain):
        host.set_values({given: 2e-4})
        host.step(H, H)
    assert failed.values(*outputs(name)) == plain.values(*outputs(name))


def test_failed_step_along_derivatives(native_fmus, tmp_path):
    """They hold for the step that is taken instead; an output's slope is that of the last one."""
    hosts = [Fmi2Host(native_fmus["gear_mesh"], tmp_path / str(k)) for k in range(2)]
    torque, speed = (hosts[0].reference[n] for n in ("pinion.tau", "pinion_left.s_y"))
    for host in hosts:
        host.set({"pinion.tau": 200.0})
        host.step(0.0, H)
        host.slave.setRealInputDerivatives([torque], [1], [SLOPE])
    with pytest.raises(FMICallException):
        hosts[0].slave.doStep(H, 1e6)
    slopes = [host.slave.getRealOutputDerivatives([speed], [1]) for host in hosts]
    assert slopes[0] == slopes[1] != [0.0]
    rows = []
    for host in hosts:
        host.step(H, H)
        rows.append(host.get(*outputs("gear_mesh")).tobytes())
    assert rows[0] == rows[1]


def test_no_step_beyond_the_stop_time(fmus, tmp_path):
    """FMI 2.0.4, section 2.1.6: it is an error; pythonfmu can but discard it."""
    host = Fmi2Host(fmus["drive_motor"], tmp_path)
    host.slave.reset()
    host.slave.setupExperiment(startTime=0.0, stopTime=0.3)
    host.slave.enterInitializationMode()
    host.slave.exitInitializationMode()
    for k in range(3):
        host.step(0.1 * k, 0.1)
    with pytest.raises(FMICallException):
        host.step(0.3, 1e-6)
    assert any("ends after the stop time of 0.3 s" in line for line in host.messages)


def test_refusals_discard_one_step(fmus, tmp_path):
    """A step that is too long, a value that is none: what follows has the bits of a plain run."""
    refused, plain = (Fmi2Host(fmus["drive_motor"], tmp_path / str(k)) for k in range(2))
    for host in (refused, plain):
        host.slave.reset()
        host.slave.setupExperiment(startTime=0.0, stopTime=0.3)
        host.slave.enterInitializationMode()
        host.slave.exitInitializationMode()
        host.set({"flange.tau": 5.0})
        host.step(0.0, 0.1)
    with pytest.raises(FMICallException):
        refused.step(0.1, 1.0)
    for size in (-0.1, math.nan):
        with pytest.raises(FMICallException):
            refused.step(0.1, size)
    refused.step(0.1, 0.1)
    plain.step(0.1, 0.1)
    with pytest.raises(FMICallException):  # of setReal, or of the step after it
        refused.set({"flange.tau": math.nan})
        refused.step(0.2, 0.1)
    for host in (refused, plain):
        host.step(0.2, 0.1)
    names = outputs("drive_motor")
    assert refused.get(*names).tobytes() == plain.get(*names).tobytes()


def test_derivatives_of_states_at_the_end_of_a_step(native_fmus, fmi3_fmus, tmp_path):
    """By the inputs there, as outputs are, until the host sets others."""
    fmi2 = Fmi2Host(native_fmus["drive_motor"], tmp_path / "2")
    torque = fmi2.reference["flange.tau"]
    fmi2.slave.setRealInputDerivatives([torque], [1], [SLOPE])
    fmi2.step(0.0, H)
    acceleration, rate = fmi2.get("flange.a", "der(speed)")
    assert rate == acceleration != 0.0
    inertia = 1.0 / ((rate - fmi2_rate_after(fmi2, torque, 0.0)) / (SLOPE * H))
    assert inertia == pytest.approx(fmi2.get("inertia")[0], rel=1e-9)
    fmi3 = Fmi3Host(fmi3_fmus["drive_motor"], tmp_path / "3", degree=1.0)
    fmi3.set({"flange.tau.node": [SLOPE * H, 0.0, 0.0, 0.0]})
    fmi3.step(0.0, H)
    assert fmi3.get("der(speed)") == fmi3.get("flange.a") == [rate]


def fmi2_rate_after(host, torque, value):
    """Rate of the speed once the host has set another torque."""
    host.slave.setReal([torque], [value])
    return host.get("der(speed)")[0]


@pytest.mark.parametrize("parameter", ["stiffness", "damping"])
def test_derivatives_by_parameters_in_initialisation(parameter, native_fmus, tmp_path):
    """FMI 2.0.4, section 2.1.9: unknowns of initialisation, by what they depend on there.

    The torque of a coupling is linear in both.
    """
    host = Fmi2Host(native_fmus["shaft_coupling"], tmp_path)
    host.slave.reset()
    host.slave.setupExperiment(startTime=0.0)
    host.slave.enterInitializationMode()
    host.set({"flange_a.phi": 0.01, "flange_b.w": 2.0})
    torque, at = (host.reference[n] for n in ("flange_a.tau", parameter))
    before = host.get("flange_a.tau").tobytes()
    (slope,) = host.slave.getDirectionalDerivative([torque], [at], [1.0])
    assert slope == pytest.approx({"stiffness": -0.01, "damping": 2.0}[parameter], rel=1e-9)
    assert host.get("flange_a.tau").tobytes() == before

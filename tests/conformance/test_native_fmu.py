"""What is special about native FMUs: the same bits as Python FMUs, errors at once, FMI 3.0."""

import zipfile

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from support.fmus import NAMES, H, outputs
from support.hosts.fmi3 import Fmi3Host

from herringbone.components.registry import COMPONENTS
from herringbone.core import ParameterError
from herringbone.core.declaring.variable import NODES
from herringbone.fmi import golden
from herringbone.fmi.validation import validation_problems

WITH_INPUTS = [name for name in NAMES if COMPONENTS[name].declaration.inputs]

STATE_VECTORS = {"modal_housing": {"q", "der(q)", "der(q,2)"}}


@pytest.fixture
def fmus(native_fmus):
    return native_fmus


@pytest.mark.parametrize("name", NAMES)
def test_same_bits_as_the_python_fmu(name, python_fmus, native_fmus):
    rows = golden.golden_run(COMPONENTS[name], native_fmus[name])
    np.testing.assert_array_equal(rows, golden.golden_run(COMPONENTS[name], python_fmus[name]))


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
@pytest.mark.parametrize("name", WITH_INPUTS)
def test_value_that_is_not_finite_is_refused_at_once(name, value, started):
    host = started(name)
    signal = COMPONENTS[name].declaration.inputs[0]
    host.step(0.0, H)
    before = host.values(signal.name)
    with pytest.raises(FMICallException):
        host.slave.setReal([host.variables[signal.name].reference], [value])
    said = f"part.{signal.name} = {value} {signal.unit}: it must be finite (t = 2e-05 s)"
    assert host.messages() == [said]
    assert host.values(signal.name) == before


@pytest.mark.parametrize("name", NAMES)
def test_every_real_is_called_by_its_name(name, started):
    host = started(name)
    reals = [v for v in host.model.modelVariables if v.type == "Real" and "der(" not in v.name]
    assert len(reals) >= len(COMPONENTS[name].declaration.variables)
    for v in reals:
        with pytest.raises(FMICallException):
            host.slave.setReal([v.valueReference], [float("nan")])
        (said,) = host.messages()
        unit = "" if v.unit == "1" else f" {v.unit}"
        assert said.startswith(f"part.{v.name} = nan{unit}: ")


def test_fixed_parameter_is_refused_after_initialisation(started):
    host = started("drive_motor")
    with pytest.raises(ParameterError, match=r"inertia = 1 kg\.m2: a fixed parameter cannot be se"):
        host.set("inertia", 1.0)
    assert host.values("inertia") == [0.08]


@pytest.mark.parametrize("call", ["Real", "Integer", "Boolean", "String"])
def test_unknown_value_reference(call, started):
    host = started("drive_motor")
    for reference in (10**6, 2**32 - 1):
        with pytest.raises(FMICallException):
            getattr(host.slave, f"get{call}")([reference])
        with pytest.raises(FMICallException):
            getattr(host.slave, f"set{call}")([reference], ["x" if call == "String" else 1])
        assert f"there is no {call} with value reference {reference}" in host.messages()[0]


def test_no_step_after_termination(started):
    host = started("load_motor")
    host.slave.terminate()
    with pytest.raises(FMICallException):
        host.slave.doStep(0.0, H)
    assert "doStep after terminate" in host.messages()[0]


def test_ramp_of_an_input_as_its_derivative_is_the_ramp_as_nodes(started):
    """An input derivative of first order is the polynomial of degree one that nodes give."""
    nodes, derivative = started("drive_motor", interface_degree=1.0), started("drive_motor")
    for n in range(5):
        start = {"flange.tau": 10.0 * n, "speed_setpoint": 100.0}
        nodes.set_values(
            start | {"flange.tau.node1": 10.0 * (n + 1), "speed_setpoint.node1": 100.0}
        )
        derivative.set_values(start)
        reference = derivative.variables["flange.tau"].reference
        derivative.slave.setRealInputDerivatives([reference], [1], [10.0 / H])
        nodes.step(n * H, H)
        derivative.step(n * H, H)
    names = outputs("drive_motor")
    np.testing.assert_allclose(derivative.values(*names), nodes.values(*names), rtol=1e-13)
    held = started("drive_motor")
    held.set_values({"speed_setpoint": 100.0})
    held.step(0.0, H)
    assert held.values("flange.w") != nodes.values("flange.w")


@pytest.mark.parametrize("name", NAMES)
def test_fmi3_description_is_valid(name, fmi3_fmus):
    assert validation_problems(fmi3_fmus[name]) == []


@pytest.mark.parametrize("name", NAMES)
def test_fmi3_nodes_are_arrays(name, fmi3_fmus):
    declaration = COMPONENTS[name].declaration
    shown = {v.name: v for v in fmpy.read_model_description(str(fmi3_fmus[name])).modelVariables}
    arrays = {v.name for v in shown.values() if v.dimensions}
    vectors = STATE_VECTORS.get(name, set())
    assert arrays == {f"{v.name}.node" for v in declaration.variables if v.nodes} | vectors
    for variable in declaration.variables:
        assert shown[variable.name].valueReference == declaration.index[variable.name]
        if variable.nodes:
            nodes = shown[f"{variable.name}.node"]
            assert nodes.valueReference == declaration.index[f"{variable.name}.node1"]
            assert [int(d.start) for d in nodes.dimensions] == [NODES]


@pytest.mark.parametrize("name", NAMES)
def test_fmi3_gives_the_bits_of_fmi2(name, started, fmi3_fmus, tmp_path):
    component = COMPONENTS[name]
    host = started(name, interface_degree=2.0)
    other = Fmi3Host(fmi3_fmus[name], tmp_path, 2.0)
    for n in range(5):
        for node in range(3):
            for signal, value in golden.inputs(component, (n + 0.5 * node) * H).items():
                host.set_values({f"{signal}.node{node}" if node else signal: value})
        for v in component.declaration.inputs:
            nodes = host.values(*(f"{v.name}.node{k}" for k in range(1, NODES + 1)))
            other.set({v.name: host.values(v.name), f"{v.name}.node": nodes})
        host.step(n * H, H)
        other.step(n * H, H)
    for v in component.declaration.outputs:
        assert other.get(v.name) == host.values(v.name)
        if v.nodes:
            nodes = host.values(*(f"{v.name}.node{k}" for k in range(1, NODES + 1)))
            assert other.get(f"{v.name}.node", NODES) == nodes
    other.close()


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize(
    ("name", "start", "signal"),
    [
        ("gear_mesh", {"pinion.tau": 50.0, "wheel.tau": -150.0}, "mesh_left.force"),
        ("drive_motor", {"speed_setpoint": 100.0}, "torque"),
        ("load_motor", {"torque_setpoint": 100.0}, "torque"),
    ],
)
def test_model_exchange_under_cvode_agrees_with_co_simulation(
    name, start, signal, fmi, native_fmus, fmi3_fmus
):
    """CVode at 1e-9; Runge-Kutta's own error is below 1e-7 (gear_mesh, its table of steps)."""
    fmu = str((native_fmus if fmi == 2 else fmi3_fmus)[name])
    options = {"stop_time": 2e-3, "start_values": start, "output": [signal]}
    exchange, steps = (
        fmpy.simulate_fmu(
            fmu, fmi_type=kind, output_interval=1e-5, relative_tolerance=1e-9, **options
        )
        for kind in ("ModelExchange", "CoSimulation")
    )
    assert abs(steps[signal][-1]) > 10.0
    np.testing.assert_allclose(exchange[signal][-1], steps[signal][-1], rtol=1e-6)


def test_states_that_are_rates_are_the_derivatives_of_others(native_fmus):
    description = fmpy.read_model_description(str(native_fmus["gear_mesh"]))
    rates = {d.variable.derivative.name: d.variable.name for d in description.derivatives}
    assert list(rates) == [v.name for v in COMPONENTS["gear_mesh"].declaration.states]
    assert rates["approach"] == "der(approach)"
    assert rates["der(approach)"] == "der(approach,2)"
    assert description.numberOfEventIndicators == 4


@pytest.mark.parametrize("name", NAMES)
def test_content_of_the_file(name, native_fmus):
    with zipfile.ZipFile(native_fmus[name]) as archive:
        names = archive.namelist()
        assert {entry.date_time for entry in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
    assert names == sorted(names)
    assert not [n for n in names if n.endswith(".py")]

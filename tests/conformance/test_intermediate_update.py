"""Intermediate update of FMI 3.0: inputs that a host gives at times within a step."""

import math

import fmpy
import pytest
from fmpy.fmi1 import FMICallException
from support.hosts.fmi3 import Fmi3Host

from herringbone.components.registry import COMPONENTS
from herringbone.core.declaring.variable import NODES
from herringbone.fmi import golden

H = 1e-4
FED = [name for name, c in COMPONENTS.items() if c.declaration.inputs]


class Host(Fmi3Host):
    """A host whose `signals` (time -> values by name) are the inputs within a step."""

    def __init__(self, fmu, folder, signals=None, degree=0.0, **options):
        self.signals, self.reached, self.asked = signals, [], []
        update = self.update if signals is not None else None
        super().__init__(fmu, folder, degree, intermediateUpdate=update, **options)

    def update(self, _environment, time, asks, may_get, finished, may_return, _early, _end):
        assert not may_return
        assert asks != may_get
        assert finished == may_get
        (self.asked if asks else self.reached).append(time)
        if asks:
            self.set(self.signals(time))


@pytest.mark.parametrize("name", FED)
def test_inputs_within_a_step_are_its_nodes(name, fmi3_fmus, tmp_path):
    """The host is asked at the nodes of degree 4, and what it gives makes the bits of nodes."""
    component = COMPONENTS[name]

    def signals(time):
        return golden.inputs(component, time)

    asked = Host(fmi3_fmus[name], tmp_path / "a", signals)
    given = Host(fmi3_fmus[name], tmp_path / "b", degree=float(NODES))
    for n in range(3):
        times = [n * H + H * k / NODES for k in range(NODES + 1)]
        rows = [signals(t) for t in times]
        for signal in rows[0]:
            values = [row[signal] for row in rows]
            given.set({signal: values[0], f"{signal}.node": values[1:]})
        given.step(n * H, H)
        asked.step(n * H, H)
        assert asked.asked[-NODES - 1 :] == times
        assert asked.reached[-1] == n * H + H
    for v in component.declaration.outputs:
        assert asked.get(v.name) == given.get(v.name)
    asked.close()
    given.close()


def turned(fmu, folder, steps, *, within):
    """Speed of the inertia under a sine of torque after a quarter of its period."""
    frequency = 2.0 * math.pi * 50.0

    def signals(time):
        return {"flange_a.tau": math.sin(frequency * time)}

    host = Host(fmu, folder, signals if within else None)
    size = 0.005 / steps
    for n in range(steps):
        host.set(signals(n * size))
        host.step(n * size, size)
    (found,) = host.get("flange_a.w")
    host.close()
    return found - 1.0 / frequency


def test_order_of_inputs_within_steps(fmi3_fmus, tmp_path):
    """A sine integrated by its polynomials of degree 4: order 5 and better; held: order 1."""
    fmu = fmi3_fmus["rotating_inertia"]
    errors = {
        (steps, within): abs(turned(fmu, tmp_path / f"{steps}{within}", steps, within=within))
        for steps in (2, 4)
        for within in (True, False)
    }
    assert math.log2(errors[2, True] / errors[4, True]) > 4.8
    assert math.log2(errors[2, False] / errors[4, False]) == pytest.approx(1.0, abs=0.2)


def test_a_host_that_gives_nothing_holds(fmi3_fmus, tmp_path):
    fmu = fmi3_fmus["drive_motor"]
    silent, plain = Host(fmu, tmp_path / "a", lambda _: {}), Host(fmu, tmp_path / "b")
    for host in (silent, plain):
        host.set({"speed_setpoint": 100.0})
        host.step(0.0, H)
    assert silent.get("flange.w") == plain.get("flange.w") != [0.0]
    silent.close()
    plain.close()


def test_what_is_no_input_is_refused_within_a_step(fmi3_fmus, tmp_path):
    refused = []

    def signals(_):
        try:
            host.slave.setFloat64([host.reference["inertia"]], [2.0])
        except FMICallException as error:
            refused.append(error.status)
        return {}

    host = Host(fmi3_fmus["rotating_inertia"], tmp_path, signals)
    host.step(0.0, H)
    assert refused == [3] * (NODES + 1)
    assert host.get("inertia") == [1.0]
    host.close()


@pytest.mark.parametrize("variable", ["flange_a.tau", "inertia"])
def test_required_variables(variable, fmi3_fmus, tmp_path):
    """Inputs need a callback; a parameter is no intermediate variable at all."""
    fmu = fmi3_fmus["rotating_inertia"]
    references = {v.name: v.valueReference for v in fmpy.read_model_description(fmu).modelVariables}
    required = {"requiredIntermediateVariables": [references[variable]]}
    with pytest.raises(Exception, match="instantiate"):  # fmpy raises bare Exception
        Host(fmu, tmp_path / "a", (lambda _: {}) if variable == "inertia" else None, **required)
    if variable == "flange_a.tau":
        Host(fmu, tmp_path / "b", lambda _: {}, **required).close()

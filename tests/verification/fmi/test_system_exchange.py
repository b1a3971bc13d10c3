"""Whole systems as one FMU in model exchange, against their co-simulation and their equations."""

from functools import cache

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from support.compiler import needs_compiler
from support.hosts.exchange import ExchangeHost

from herringbone.components.registry import COMPONENTS
from herringbone.core import Instance
from herringbone.core.places.paths import component_folder
from herringbone.fmi.validation import validation_problems
from herringbone.running.exporting.system_fmu import export_fmu

MICRO_STEP, INTERVAL, DURATION = 1e-7, 1e-5, 5e-3
MESH, SHIPPED_MODES = "gear_mesh", 60
BUILT = [("gearbox", 2), ("gearbox", 3), ("test_rig", 2)]
SCOPE = {"gearbox": "", "test_rig": "gearbox."}
"""Where the parts of the gearbox are."""
EPS = np.finfo(float).eps

pytestmark = [
    pytest.mark.slow,
    needs_compiler,
]


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    """Function: a shipped system as one FMU."""
    folder = tmp_path_factory.mktemp("systems")
    return cache(lambda name, fmi: export_fmu(name, folder / f"{name}_{fmi}.fmu", fmi=fmi))


@pytest.fixture
def opened(exported, tmp_path):
    """Function: model exchange of a shipped system, in continuous-time mode."""
    hosts = []

    def open_(name, fmi, **values):
        hosts.append(ExchangeHost(exported(name, fmi), tmp_path / str(len(hosts))))
        hosts[-1].set(**values)
        hosts[-1].initialise()
        return hosts[-1]

    yield open_
    for host in hosts:
        host.close()


@pytest.mark.parametrize(("name", "fmi"), BUILT)
def test_nothing_is_found_in_the_description(name, fmi, exported):
    assert validation_problems(exported(name, fmi)) == []


@pytest.mark.parametrize(("name", "fmi"), BUILT)
def test_model_exchange_agrees_with_co_simulation(name, fmi, exported):
    """CVode at 1e-12; Runge-Kutta at 0.1 us has an error below 1e-6 even of axial accelerations."""
    fmu = str(exported(name, fmi))
    shown = fmpy.read_model_description(fmu).modelVariables
    outputs = [v.name for v in shown if v.causality == "output" and ".node" not in v.name]
    exchange, steps = (
        fmpy.simulate_fmu(
            fmu,
            fmi_type=kind,
            solver="CVode",
            stop_time=DURATION,
            output_interval=INTERVAL,
            relative_tolerance=1e-12,
            record_events=False,
            start_values={"micro_step": MICRO_STEP},
            output=outputs,
        )
        for kind in ("ModelExchange", "CoSimulation")
    )
    np.testing.assert_allclose(exchange["time"], steps["time"], rtol=1e-12)
    assert np.ptp(steps[f"{SCOPE[name]}{MESH}.mesh_left.force"]) > 10.0
    moving = 0
    for output in outputs:
        scale = np.abs(steps[output]).max()
        assert np.abs(exchange[output] - steps[output]).max() <= 1e-6 * scale, output
        moving += np.ptp(steps[output]) > 0.0
    assert moving > 50


def test_nominal_values_are_the_size_of_the_motion(exported):
    """Of modes that a symmetric load does not excite, little is seen; no mode exceeds its size."""
    fmu = str(exported("gearbox", 2))
    shown = {v.name: v for v in fmpy.read_model_description(fmu).modelVariables}
    modes = [f"modal_housing.q[{k + 1}]" for k in range(SHIPPED_MODES)]
    result = fmpy.simulate_fmu(fmu, fmi_type="CoSimulation", stop_time=DURATION, output=modes)
    sizes = np.array([np.abs(result[n]).max() / float(shown[n].nominal) for n in modes])
    assert sizes.max() < 10.0
    assert (sizes > 0.1).sum() > 10


@pytest.mark.parametrize(("name", "fmi"), BUILT)
def test_states_are_those_of_the_parts(name, fmi, opened):
    host = opened(name, fmi)
    modes = [n for n in host.states if "modal_housing.q[" in n]
    assert len(modes) == 2 * SHIPPED_MODES
    assert modes[0] == f"{SCOPE[name]}modal_housing.q[1]"
    assert modes[-1] == f"der({SCOPE[name]}modal_housing.q[{SHIPPED_MODES}])"
    mesh = [v.name for v in COMPONENTS[MESH].declaration.states]
    motors = 7 * (name == "test_rig")
    assert len(host.states) == len(modes) + len(mesh) + motors


@pytest.mark.parametrize(("name", "fmi"), BUILT)
def test_event_indicators_are_those_of_the_mesh(name, fmi, opened):
    host = opened(name, fmi)
    mesh, path = COMPONENTS[MESH], SCOPE[name] + MESH
    index, count = mesh.declaration.index, mesh.declaration.state_count
    block = Instance(mesh, MESH).block
    for v in mesh.declaration.parameters:
        if (reference := host.reference.get(f"{path}.{v.name}")) is not None:
            getter = host.fmu.getFloat64 if host.third else host.fmu.getReal
            block[index[v.name]] = getter([reference])[0]
    places = [
        host.states.index(
            f"der({path}.{v.name[4:]}" if v.name[:4] == "der(" else f"{path}.{v.name}"
        )
        for v in mesh.declaration.states
    ]
    signs = set()
    x, expected = host.x, np.zeros(mesh.indicator_count)
    for approach in (1e-3, -5e-6, -1e-3):
        x[places[index["approach"]]] = approach
        host.x = x
        block[:count] = x[places]
        mesh.indicators(block, 0.0, expected)
        assert host.indicators.tolist() == expected.tolist()
        signs.add(tuple(np.sign(expected)))
    assert len(signs) == 3  # drive contact, open, coast contact


@pytest.mark.parametrize(("name", "fmi"), BUILT)
def test_directional_derivatives_are_the_differences(name, fmi, opened):
    host = opened(name, fmi)
    at = host.x + 1e-3 * host.nominals * np.cos(np.arange(len(host.states)))

    def values(k, change):
        x = at.copy()
        x[k] += change
        host.x = x
        return np.concatenate([host.dx, host.outputs()])

    def differences(k, change):
        return (values(k, change) - values(k, -change)) / (2.0 * change)

    size = np.abs(values(0, 0.0)) + 1e-9
    size[: len(host.states)] = np.maximum(size[: len(host.states)], size[: len(host.states)].mean())
    # Outputs are sums whose terms cancel: rounding is of those of their kind (s_, v_, a_, ...).
    kinds = np.array([n.rpartition(".")[2][:2] for n in host.output_names])
    for kind in set(kinds):
        own = np.flatnonzero(kinds == kind) + len(host.states)
        size[own] = np.maximum(size[own], size[own].mean())
    for k, state in enumerate(host.states):
        change = 1e-4 * host.nominals[k]
        found = differences(k, change)
        truncation = np.abs(differences(k, 2.0 * change) - found)
        host.x = at
        exact = host.tangent(state)
        rounding = 1e4 * EPS * (size / change + np.abs(exact))
        wrong = np.abs(exact - found) > rounding + truncation
        names = np.array([*host.rates, *host.output_names])
        assert not wrong.any(), (state, names[wrong], exact[wrong], found[wrong])


def test_a_housing_of_other_data_is_built_for_these(tmp_path):
    """A system whose other parts stay outside makes an FMU of one part, with its data."""
    folder = component_folder("modal_housing") / "resources"
    values = {
        f"modal_housing.{name}": str(folder / f"thesis_{name}.csv") for name in ("modes", "shapes")
    }
    fmu = export_fmu(
        "gearbox", tmp_path / "one.fmu", outside=(MESH, "bearing_supports"), values=values
    )
    assert validation_problems(fmu) == []
    host = ExchangeHost(fmu, tmp_path / "one")
    host.initialise()
    modes = [f"modal_housing.q[{k}]" for k in range(1, 5)]
    assert host.states == [*modes, *(f"der({mode})" for mode in modes)]
    host.set(**{"modal_housing.wheel_left.f_y": 1e3})
    assert np.abs(host.dx[4:]).min() > 0.0
    host.fmu.reset()
    for name in ("modes", "shapes"):
        text = [host.reference[f"modal_housing.{name}"]]
        host.fmu.setString(text, [str(folder / f"{name}.csv")])
    host.fmu.enterInitializationMode()
    with pytest.raises(FMICallException):
        host.fmu.exitInitializationMode()
    assert f"modes.csv: {SHIPPED_MODES} modes, but this FMU was built for 4" in host.messages[-1]
    host.fmu.freeInstance()


def test_restored_state_brings_its_parameters_back(opened):
    """The parts compute with copies of the parameters, which must follow."""
    stiffness = "bearing_supports.pinion.radial_stiffness"
    host = opened("gearbox", 2, **{stiffness: 1e8})
    expected, saved = host.dx, host.fmu.getFMUstate()
    host.fmu.reset()
    host.initialise()
    assert (host.dx != expected).any()
    host.fmu.setFMUstate(saved)
    assert (host.dx == expected).all()

"""fmpy runs the native FMUs: mesh and housing under CVode; both FMI versions with equal results."""

import fnmatch
from functools import cache

import fmpy
import numpy as np
import pytest
from support.fmus import NAMES

import herringbone as hb
from herringbone.components.registry import COMPONENTS
from herringbone.cosim.ssp.described import DescribedPart
from herringbone.cosim.structure.network import build_network
from herringbone.fmi import golden
from herringbone.fmi.native import build_native_fmus
from herringbone.running.loading import load_scene, load_system
from herringbone.running.start import started

MESH, HOUSING = "gear_mesh", "modal_housing"
HOLD, DURATION = 1e-5, 1e-2
"""Time over which an input is held, and end of the run [s]."""


@pytest.fixture(scope="module")
def fmi3_fmus(native_fmus):
    """Path of the native FMU 3.0 by component."""
    return build_native_fmus(fmi=3)


def held(time, rows, names):
    """Signals for fmpy that hold each row until the next time: two samples at each time."""
    signals = np.zeros(2 * len(time) - 1, dtype=[(n, np.double) for n in ("time", *names)])
    signals["time"][0::2], signals["time"][1::2] = time, time[1:]
    for name, column in zip(names, np.transpose(rows), strict=True):
        signals[name][0::2], signals[name][1::2] = column, column[:-1]
    return signals


@pytest.fixture(scope="module")
def recorded(native_fmus):
    """Function: inputs of a part in a run of the test rig, and its start values there."""

    @cache
    def record(scene, name):
        system, folder = load_system("test_rig")
        system, _ = started(system, load_scene(folder, scene))
        result = hb.run(
            "test_rig", scene=scene, step=HOLD, record_step=HOLD, t_end=DURATION, fmu="native"
        )
        parts = [
            DescribedPart(p.name, native_fmus[str(p.component)], p.values) for p in system.parts
        ]
        place = system.paths.index(system.part(name).name)
        connected = build_network(system, parts).inputs(place)
        columns = [f"{parts[c.source].name}.{c.output}" for c in connected]
        names = [c.input for c in connected]
        assert sorted(names) == sorted(v.name for v in COMPONENTS[name].declaration.inputs)
        rows = result.data[columns].to_numpy()
        return held(result.data["time"].to_numpy(), rows, names), dict(system.part(name).values)

    return record


def both_kinds(fmu, signals, start, outputs):
    """Results of model exchange under CVode and of co-simulation, under the same held inputs."""
    return (
        fmpy.simulate_fmu(
            str(fmu),
            fmi_type=kind,
            solver="CVode",
            stop_time=DURATION,
            output_interval=HOLD,
            relative_tolerance=1e-11,
            record_events=False,
            start_values=start,
            input=signals,
            output=outputs,
        )
        for kind in ("ModelExchange", "CoSimulation")
    )


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize(
    ("scene", "micro_step", "pattern"),
    [("loaded", 2.5e-6, "mesh_*.force"), ("loaded", 2.5e-7, "*"), ("separation", 2.5e-7, "*")],
)
def test_mesh_under_cvode_agrees_with_its_co_simulation(
    scene, micro_step, pattern, fmi, native_fmus, fmi3_fmus, recorded
):
    """Inputs are held, since fmpy sets them once per step of CVode; it starts anew at each jump.

    CVode at 1e-11 is within 1e-7. At the default micro step Runge-Kutta's own error is below 1e-6
    in the forces, but 7e-6 of the small axial velocities; it falls with the step. It takes micro
    steps in parts where the teeth part and meet, which CVode finds by the event indicators.
    """
    signals, start = recorded(scene, MESH)
    outputs = [v.name for v in COMPONENTS[MESH].declaration.outputs if not v.feedthrough]
    fmu = (native_fmus if fmi == 2 else fmi3_fmus)[MESH]
    exchange, steps = both_kinds(fmu, signals, {**start, "micro_step": micro_step}, outputs)
    np.testing.assert_allclose(exchange["time"], steps["time"], rtol=1e-12)
    compared = fnmatch.filter(outputs, pattern)
    assert "mesh_left.force" in compared
    scale = {name: np.abs(steps[name]).max() for name in compared}
    worst = {name: np.abs(exchange[name] - steps[name]).max() / scale[name] for name in compared}
    assert {name: error for name, error in worst.items() if error > 1e-6} == {}
    assert np.ptp(steps["mesh_left.force"]) > 1e-2 * scale["mesh_left.force"]
    assert (steps["mesh_left.force"] == 0.0).any() == (scene == "separation")


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("scene", ["loaded", "separation"])
def test_housing_under_cvode_agrees_with_its_co_simulation(
    scene, fmi, native_fmus, fmi3_fmus, recorded
):
    """Co-simulation propagates the modes exactly under held forces; CVode at 1e-11 integrates."""
    signals, start = recorded(scene, HOUSING)
    outputs = [v.name for v in COMPONENTS[HOUSING].declaration.outputs if not v.feedthrough]
    fmu = (native_fmus if fmi == 2 else fmi3_fmus)[HOUSING]
    exchange, steps = both_kinds(fmu, signals, start, outputs)
    np.testing.assert_allclose(exchange["time"], steps["time"], rtol=1e-12)
    assert len(outputs) == 24
    for name in outputs:
        scale = np.abs(steps[name]).max()
        assert np.ptp(steps[name]) > 1e-3 * scale
        assert np.abs(exchange[name] - steps[name]).max() < 1e-6 * scale, name


@pytest.mark.parametrize("name", NAMES)
def test_both_fmi_versions_give_the_same_bits(name, native_fmus, fmi3_fmus):
    component = COMPONENTS[name]
    inputs = [v.name for v in component.declaration.inputs]
    outputs = golden.columns(component)[1:]
    time = np.arange(golden.STEPS + 1) * golden.STEP_SIZE
    rows = [list(golden.inputs(component, t).values()) for t in time]
    second, third = (
        fmpy.simulate_fmu(
            str(fmus[name]),
            fmi_type="CoSimulation",
            stop_time=time[-1],
            output_interval=golden.STEP_SIZE,
            input=held(time, rows, inputs) if inputs else None,
            output=outputs,
        )
        for fmus in (native_fmus, fmi3_fmus)
    )
    assert len(second) == golden.STEPS + 1
    assert np.abs([second[n][-1] for n in outputs]).max() > 0.0
    for column in ("time", *outputs):
        np.testing.assert_array_equal(second[column], third[column])

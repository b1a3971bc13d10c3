"""Foreign FMUs that hold their inputs: fourth order in every cut, third without roll-back."""

import numpy as np
import pytest
from support.foreign.kinds import without_states
from support.foreign.oscillator import JOINED, Oscillator
from support.foreign.strangers import write_system

import herringbone as hb

STEPS = np.array([10e-3, 5e-3, 2.5e-3, 1e-3])
STATED = {"fourth order in the step at most": 4.0, "third order in the step": 3.0}
"""What lines on parts say of the order."""


def slopes(steps, errors):
    return np.diff(np.log(errors)) / np.diff(np.log(steps))


def stated_order(result):
    """The lowest that lines on parts state."""
    return min(order for text, order in STATED.items() if text in " ".join(result.info.notes))


@pytest.mark.parametrize("damping", [0.0, 0.01])
@pytest.mark.parametrize("cut", JOINED)
def test_oscillator(kinds, cut, damping):
    """Fourth order, as two moments of every input are kept: 0.3 % at 10 ms, energy 0.01 %."""
    oscillator = Oscillator(kinds, cut, damping)
    runs = [oscillator.run("li:degree=3", step) for step in STEPS]
    found = [oscillator.errors(run) for run in runs]
    rms = np.array([error for error, _ in found])
    assert slopes(STEPS, rms) == pytest.approx(stated_order(runs[0]), abs=0.2)
    assert rms[0] < 3e-3
    assert rms[-1] < 1e-3
    assert max(energy for _, energy in found) < 1e-4


@pytest.mark.parametrize("damping", [0.0, 0.01])
@pytest.mark.parametrize("cut", JOINED)
def test_oscillator_of_fmi_derivatives(kinds, cut, damping):
    """Inputs with three derivatives, outputs with one: cubics on both ways, fourth order."""
    oscillator = Oscillator(kinds, cut, damping, mass="curve")
    rms = [oscillator.errors(oscillator.run("li:degree=3", step))[0] for step in STEPS[:3]]
    assert slopes(STEPS[:3], rms) == pytest.approx(4.0, abs=0.2)
    assert rms[0] < 3e-3


@pytest.mark.parametrize("cut", JOINED)
def test_oscillator_without_roll_back(kinds, cut):
    """The default: third order at least; never worse than parallel Jacobi."""
    oscillator = Oscillator(kinds, cut, 0.01, plain=True)
    runs = [oscillator.run(None, step) for step in STEPS]
    rms = [oscillator.errors(run)[0] for run in runs]
    assert slopes(STEPS, rms).min() > stated_order(runs[0]) - 0.1
    assert runs[-1].info.passes["one"] == runs[-1].info.macro_steps
    for step, error in zip(STEPS, rms, strict=True):
        parallel = oscillator.run("jacobi:order=0,schedule=parallel", step)
        assert error < oscillator.errors(parallel)[0]


def driveline(folder, plain):
    names = ("EDrive", "RoadVehicle")
    files = [folder / f"{name}.fmu" for name in names]
    if plain:
        files = [without_states(file) for file in files]
    path = write_system(
        folder,
        f"driveline{'p' if plain else ''}",
        [["drive.flange", "gearbox.pinion"], ["vehicle.gearbox", "gearbox.wheel"]],
        dict(zip(("drive", "vehicle"), files, strict=True)),
    )
    with (path / "system.toml").open("a", encoding="utf-8") as file:
        file.write('\ngearbox = { system = "gearbox" }\n')
    return path


def pull_away(system, step, algorithm=None):
    """Torque of the motor's shaft, every 0.1 ms."""
    result = hb.run(
        system, algorithm=algorithm, step=step, record_step=1e-4, t_end=0.02, start="rest",
        values={"drive.torque_set": 200.0},
    )  # fmt: skip
    assert result.outcome.completed
    return result.data["drive.flange.tau"].to_numpy()


@pytest.fixture(scope="module")
def converged(kinds):
    return pull_away(driveline(kinds, plain=False), 5e-6, "li:degree=4")


@pytest.mark.parametrize("plain", [False, True], ids=["restores", "plain"])
@pytest.mark.parametrize("step", [20e-6, 100e-6])
def test_motor_and_vehicle_on_the_gearbox(kinds, converged, step, plain):
    """The default algorithm: 1 % of the mean, and no jump in the first step."""
    torque = pull_away(driveline(kinds, plain), step)
    mean = np.abs(converged).mean()
    assert np.std(torque - converged) < 0.01 * mean
    assert abs(torque[1] - converged[1]) < 0.01 * mean


def test_a_single_fmu_is_stepped_once_per_record(kinds, tmp_path):
    """12 kg and 8 N s/m under 10 N, exact in the FMU: v = F / c (1 - exp(-c t / m))."""
    system = write_system(tmp_path, "alone", [], {"mass": kinds / "LinearCarriage.fmu"})
    run = hb.run(system, start="rest", t_end=0.01, record_step=1e-3, values={"mass.force_in": 10.0})
    assert run.info.macro_steps == 10
    assert run.info.passes == {"mass": 10}
    time = run.data["time"].to_numpy()
    exact = 10.0 / 8.0 * (1.0 - np.exp(-8.0 * time / 12.0))
    assert run.data["mass.velocity"].to_numpy() == pytest.approx(exact, rel=1e-12)
    assert not any(row.source == "coupling" for row in run.budget)

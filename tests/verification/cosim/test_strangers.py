"""Foreign FMUs that hold their inputs: second order in every cut, with and without roll-back."""

import numpy as np
import pytest
from support.kinds import without_states
from support.oscillator import JOINED, Oscillator
from support.strangers import write_system

import herringbone as hb

STEPS = np.array([10e-3, 5e-3, 2.5e-3, 1e-3])


@pytest.mark.parametrize("damping", [0.0, 0.01])
@pytest.mark.parametrize("cut", JOINED)
def test_oscillator(kinds, cut, damping):
    """Slope 1.9 to 2.1 with roll-back; at 1 ms 0.1 % of the displacement, 0.01 % of the energy."""
    oscillator = Oscillator(kinds, cut, damping)
    found = [oscillator.errors(oscillator.run("li:degree=3", step)) for step in STEPS]
    rms = np.array([error for error, _ in found])
    slopes = np.diff(np.log(rms)) / np.diff(np.log(STEPS))
    assert ((slopes > 1.9) & (slopes < 2.1)).all()
    assert rms[-1] < 1e-3
    assert found[-1][1] < 1e-4


@pytest.mark.parametrize("cut", JOINED)
def test_oscillator_without_roll_back(kinds, cut):
    """No worse than the same algorithm of first order, and of second order itself."""
    oscillator = Oscillator(kinds, cut, 0.01, plain=True)
    rms = [oscillator.errors(oscillator.run("jacobi:order=2", step))[0] for step in STEPS]
    assert rms[-1] < 1e-3
    assert np.log(rms[-2] / rms[-1]) / np.log(2.5) > 1.9
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

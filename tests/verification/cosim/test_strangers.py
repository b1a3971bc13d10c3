"""Foreign FMUs that hold their inputs: second order in every cut, with and without roll-back.

The linear oscillator is that of the co-simulation benchmarks of the Laboratorio de Ingenieria
Mecanica, Universidade da Coruna: two masses of 1 kg on springs of 10 and 1000 N/m to ground, joined
by one of 100 N/m, at +-100 m/s, without dampers or with 0.01 N s/m each; its solution is exact.
"""

import numpy as np
import pytest
from scipy.linalg import expm
from support.kinds import without_states

import herringbone as hb

JOINED = {
    "force and motion": [["one.fo", "two.f"], ["two.x", "one.xo"], ["two.v", "one.vo"]],
    "motion and motion": [
        ["one.x", "two.xo"], ["one.v", "two.vo"], ["two.x", "one.xo"], ["two.v", "one.vo"],
    ],
    "force and force": [
        ["one.x", "spring.xa"], ["one.v", "spring.va"], ["two.x", "spring.xb"],
        ["two.v", "spring.vb"], ["spring.fa", "one.f"], ["spring.fb", "two.f"],
    ],
}  # fmt: skip
"""The three cuts of the benchmark: which part has the spring between the masses."""
OWNERS = {"force and motion": ["one"], "motion and motion": ["one", "two"], "force and force": []}
STEPS = np.array([10e-3, 5e-3, 2.5e-3, 1e-3])
SOURCES = {"one": "mass", "two": "mass", "spring": "spring"}


def write_system(folder, name, connections, files):
    """A system of FMUs."""
    path = folder / name
    path.mkdir(exist_ok=True)
    parts = [f'{part} = {{ fmu = "{file}" }}' for part, file in files.items()]
    lines = [f'name = "{name}"', f"connections = {connections}", "[parts]", *parts]
    (path / "system.toml").write_text("\n".join(lines), encoding="utf-8")
    return path


class Oscillator:
    """A cut of the oscillator."""

    def __init__(self, folder, cut, damping, plain=False):
        self.damping = damping
        used = ["one", "two"] if OWNERS[cut] else list(SOURCES)
        files = {part: folder / f"oscillator_{SOURCES[part]}.fmu" for part in used}
        if plain:
            files = {part: without_states(file) for part, file in files.items()}
        name = "".join(word[0] for word in cut.split()) + ("p" if plain else "")
        self.system = write_system(folder, name, JOINED[cut], files)
        self.values = {"one.k": 10.0, "two.k": 1000.0, "one.v0": 100.0, "two.v0": -100.0}
        self.values |= {"one.c": damping, "two.c": damping}
        for part in OWNERS[cut]:
            self.values |= {f"{part}.ko": 100.0, f"{part}.co": damping}
        if not OWNERS[cut]:
            self.values |= {"spring.c": damping}

    def run(self, algorithm, step, t_end=10.0):
        return hb.run(
            self.system, algorithm=algorithm, step=step, record_step=step, t_end=t_end,
            start="rest", values=self.values,
        )  # fmt: skip

    def exact(self, time):
        stiffness = np.array([[110.0, -100.0], [-100.0, 1100.0]])
        damping = self.damping * np.array([[2.0, -1.0], [-1.0, 2.0]])
        a = np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness, -damping]])
        over, state = expm(a * (time[1] - time[0])), np.array([0.0, 0.0, 100.0, -100.0])
        found = [state]
        for _ in time[1:]:
            found.append(over @ found[-1])
        return np.array(found)

    def errors(self, result):
        """Of the displacements, rms over rms; of the energy at the end, over its start."""
        data = result.data
        true = self.exact(data["time"].to_numpy())
        found = data[["one.x", "two.x"]].to_numpy()
        rms = np.linalg.norm(found - true[:, :2]) / np.linalg.norm(true[:, :2])
        x, v = found[-1], data[["one.v", "two.v"]].to_numpy()[-1]
        energies = [
            0.5 * (v @ v + 10.0 * x[0] ** 2 + 1000.0 * x[1] ** 2 + 100.0 * (x[0] - x[1]) ** 2)
            for x, v in ((x, v), (true[-1, :2], true[-1, 2:]))
        ]
        return rms, abs(energies[0] - energies[1]) / 1e4


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

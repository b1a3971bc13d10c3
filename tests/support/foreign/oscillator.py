"""The linear oscillator of the co-simulation benchmarks, as foreign FMUs in three cuts.

Laboratorio de Ingenieria Mecanica, Universidade da Coruna: two masses of 1 kg on springs of 10 and
1000 N/m to ground, joined by one of 100 N/m, at +-100 m/s, without dampers or with 0.01 N s/m each;
its solution is exact.
"""

import numpy as np
from scipy.linalg import expm

import herringbone as hb
from support.foreign.kinds import without_states
from support.foreign.strangers import write_system

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


class Oscillator:
    """A cut of the oscillator.

    Args:
        folder: with the FMUs.
        cut: of `JOINED`.
        damping: of all dampers [N s/m].
        plain: FMUs that do not save their states.
        mass: kind of the masses' FMUs.
    """

    def __init__(self, folder, cut, damping, *, plain=False, mass="mass"):
        self.damping = damping
        kinds = {"one": mass, "two": mass} | ({} if OWNERS[cut] else {"spring": "spring"})
        files = {part: folder / f"oscillator_{kind}.fmu" for part, kind in kinds.items()}
        if plain:
            files = {part: without_states(file) for part, file in files.items()}
        name = "".join(word[0] for word in cut.split()) + mass + ("p" if plain else "")
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

    def group_errors(self, result):
        """Of displacements and of velocities against the exact solution, rms over rms."""
        data = result.data
        true = self.exact(data["time"].to_numpy())
        found = data[["one.x", "two.x", "one.v", "two.v"]].to_numpy()
        parts = {"displacements": slice(0, 2), "velocities": slice(2, 4)}
        return {
            name: np.linalg.norm((found - true)[:, part]) / np.linalg.norm(true[:, part])
            for name, part in parts.items()
        }

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

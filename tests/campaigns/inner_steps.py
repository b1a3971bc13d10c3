"""What micro steps of the gear pair err, and what they cost.

    python -m campaigns.inner_steps

in tests/. Coupled runs against the same coupling with micro steps of 0.2 us: errors of bearing
forces and seat velocities over what alternates. The macro step is a whole number of all micro
steps from node to node. Then what the mean force of a mesh with a constant deflection errs over
40 us, over what alternates: taken at the five nodes of a collocated step, and by steps of
Runge-Kutta (Simpson's rule). So finely the stiffness table wants to be looked at, however exact the
rest is. Then CPU time of a step of the gear pair alone, loaded and turning.
"""

import math
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from support.gearing.gear_mesh import STATES, Seats, equilibrium
from support.gearing.own_pair import write_pair

import herringbone as hb
from campaigns.plans import tell
from herringbone.analysis.accuracy.error import relative_error
from herringbone.components.gear_mesh import GEAR_MESH
from herringbone.components.gear_mesh import layout as at
from herringbone.core import Instance
from herringbone.core.declaring.variable import NODES
from herringbone.kernels.force_law import law
from herringbone.result.result import Result

DEGREE, STEP, T_END = 3, 30e-6, 0.021
MICRO_STEPS = (2.5e-6, 3.34e-6, 5e-6, 10e-6)
FINE = 2e-7
LENGTHS = (40e-6, 62.5e-6)
_INNER = math.sqrt(3 / 7)
WEIGHTS, NODES_OF = (0.05, 49 / 180, 16 / 45, 49 / 180, 0.05), (-1.0, -_INNER, 0.0, _INNER, 1.0)
"""Lobatto's, from -1 to 1 (Abramowitz and Stegun, Handbook of Mathematical Functions, 25.4.32)."""
SPEEDS, PARTS, DEPTH, TEETH = (1000, 3000), (2, 3, 4, 6), 4.8e-6, 27
_R_MIN = math.pi / 30.0


class Case(NamedTuple):
    """A run of the test rig.

    Attributes:
        name: what it is.
        options: of `hb.run`.
    """

    name: str
    options: Mapping[str, object]


def _cases(folder: Path) -> Iterator[Case]:
    yield Case("loaded", {"scene": "loaded"})
    yield Case("separation", {"scene": "separation"})
    yield Case("3000 r/min, 400 N m", {"speed": 3000 * _R_MIN, "torque": 400.0})
    yield Case("23/57 teeth", {"gear": write_pair(folder / "own.toml")})
    deviations = write_pair(folder / "teeth.toml")
    deviations.write_text(deviations.read_text() + "[deviations]\ngrade = 6\nseed = 1\n")
    yield Case("23/57 teeth of grade 6", {"gear": deviations})
    apart = {"scene": "separation", "gear": deviations}
    yield Case("23/57 teeth of grade 6, separation", apart)


def _run(case: Case, micro_step: float) -> Result:
    return hb.run(
        "test_rig", algorithm=f"li:degree={DEGREE}", step=STEP, t_end=T_END,
        record_step=2.0 * STEP, fmu="in-process", values={"gear_mesh.micro_step": micro_step},
        **case.options,
    )  # fmt: skip


def _groups(result: Result) -> list[np.ndarray]:
    groups = ("bearing_force", "seat_velocity")
    return [result.data[result.channel(name)].to_numpy() for name in groups]


def _errors(folder: Path) -> None:
    shown = "".join(f"{1e6 * micro_step:17.3g} us" for micro_step in MICRO_STEPS)
    tell(f"{'errors: bearing forces, seat velocities':42s}{shown}")
    for case in _cases(folder):
        exact = _groups(_run(case, FINE))
        line = f"{case.name:42s}"
        for micro_step in MICRO_STEPS:
            found = zip(_groups(_run(case, micro_step)), exact, strict=True)
            line += "".join(f"{relative_error(*pair):10.2g}" for pair in found)
        tell(line)


def _seconds(gear: Instance, x: np.ndarray, h: float, count: int = 50) -> float:
    """CPU time [s] of a step, the least of some series."""
    least, start, own, work = math.inf, gear.block.copy(), gear.block, gear.work
    start[:STATES] = x
    step, times = gear.component.kernels.step, [k * h for k in range(count)]
    for _ in range(40):
        own[:] = start
        begin = time.thread_time()
        for t in times:
            step(own, work, t, h)
        least = min(least, time.thread_time() - begin)
    return least / count


def _means(gear: Instance) -> None:
    starts, table = np.arange(997) / 997, at.TABLE[0]

    def force(turned: float) -> np.ndarray:
        return np.array([law(gear.block, table, p + turned, DEPTH)[0] for p in starts])

    size = np.std(force(0.0))
    for speed in SPEEDS:
        periods = LENGTHS[0] * TEETH * speed / 60.0

        def mean(weights: Sequence[float], places: Sequence[float]) -> np.ndarray:
            pairs = zip(weights, places, strict=True)
            return sum(by * force(periods * c) for by, c in pairs)  # noqa: B023

        exact = mean(np.full(256, 1 / 256), (np.arange(256) + 0.5) / 256)
        found = {"five nodes": mean(WEIGHTS, 0.5 + 0.5 * np.array(NODES_OF))}
        for parts in PARTS:
            weights = np.tile([1 / 6, 4 / 6, 1 / 6], parts) / parts
            places = (np.arange(parts)[:, None] + [0.0, 0.5, 1.0]).ravel() / parts
            found[f"{parts} steps"] = mean(weights, places)
        errors = {k: math.sqrt(np.mean((v - exact) ** 2)) / size for k, v in found.items()}
        shown = "   ".join(f"{name} {error:.2g}" for name, error in errors.items())
        tell(f"{f'mean force over 40 us, {speed} r/min':42s}{shown}")


def _alone() -> None:
    gear = Instance(GEAR_MESH, "gear")
    gear.set("interface_degree", DEGREE)
    gear.initialise()
    _means(gear)
    x, index = equilibrium(gear, Seats()), gear.component.declaration.index
    x[index["der(angle)"]] = 1000 * _R_MIN
    for v in gear.component.declaration.inputs:
        first = index[v.name]
        gear.block[first + 1 : first + 1 + NODES] = gear.block[first]
    for h in LENGTHS:
        line = f"{f'CPU time of a step of {1e6 * h:.4g} us, us':42s}"
        for micro_step in MICRO_STEPS:
            gear.set("micro_step", micro_step)
            line += f"{1e6 * _seconds(gear, x, h):20.2f}"
        tell(line)


def main() -> int:
    """Print all tables."""
    with tempfile.TemporaryDirectory() as folder:
        _errors(Path(folder))
    _alone()
    return 0


if __name__ == "__main__":
    sys.exit(main())

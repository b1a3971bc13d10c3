"""What several tests share: stiffness tables, a gear pair in some state, rigid seats."""

import math
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pytest

from herringbone.components.gear_mesh import GEAR_MESH
from herringbone.components.ports import HALVES
from herringbone.core import Instance
from herringbone.core.places.paths import component_folder

MESH_STIFFNESS = 2.011e9
"""Both halves together [N/m], as in the thesis."""
RADIAL_STIFFNESS = 6.34e8
AXIAL_STIFFNESS = 2.03e8
HALF_MASS = {"pinion": 6.500, "wheel": 47.739}
STATES = 24
INDEX = GEAR_MESH.declaration.index
SHIPPED = component_folder("gear_mesh") / "resources" / "mesh_stiffness.csv"
SPEED = 1000 * math.pi / 30
FORCES = [f"{half}.f_{axis}" for half in HALVES for axis in "yz"]

Rhs = Callable[[np.ndarray], np.ndarray]


def write_table(
    path: Path,
    stiffness: Callable[[float, float], float],
    loads: tuple[float, ...] = (10.0, 1e5),
    phases: int = 8,
) -> Path:
    """A stiffness table stiffness(phase, load) [N/m], the same on both sides."""
    rows = [
        f"{side},{load!r},{i / phases!r},{stiffness(i / phases, load)!r}"
        for side in ("left", "right")
        for load in loads
        for i in range(phases)
    ]
    head = ["# units: load N, phase 1, stiffness N/m", "side,load,phase,stiffness"]
    path.write_text("\n".join(head + rows) + "\n", encoding="utf-8")
    return path


def constant_table(path: Path, stiffness: float = MESH_STIFFNESS / 2) -> Path:
    """A table whose force law is stiffness * deflection, at any load and phase."""
    return write_table(path, lambda phase, load: stiffness)


def gear_pair(table: Path, parameters: Mapping[str, float | str] | None = None) -> Instance:
    """An initialised gear pair with the given table and parameters."""
    gear = Instance(GEAR_MESH, "gear")
    gear.set("stiffness_table", str(table))
    for name, value in (parameters or {}).items():
        gear.set(name, value)
    gear.initialise()
    return gear


def write_errors(path: Path, rows: list[tuple]) -> Path:
    """A given transmission error; rows of side, flank, gear, order, amplitude [m], phase [rad]."""
    head = ["# units: order 1, amplitude m, phase rad", "side,flank,gear,order,amplitude,phase"]
    lines = [",".join(map(str, row)) for row in rows]
    path.write_text("\n".join(head + lines) + "\n", encoding="utf-8")
    return path


UNDAMPED = {
    "mesh_damping_ratio": 0.0,
    "pinion_axial_drag": 0.0,
    **{f"{g}.shaft_damping_{axis}": 0.0 for g in ("pinion", "wheel") for axis in "yzt"},
}


class Seats:
    """Springs and dampers from the gear halves to ground, as thesis table 3.1; 2 % damping."""

    def __init__(self, radial: float = RADIAL_STIFFNESS, axial: float = AXIAL_STIFFNESS) -> None:
        self.bonds = []
        for half in HALVES:
            gear = half.split("_", maxsplit=1)[0]
            for axis, k in (("y", radial), ("z", axial if gear == "wheel" else 0.0)):
                self.bonds.append((f"{half}.f_{axis}", k, 0.04 * np.sqrt(k * HALF_MASS[gear])))


def positions(gear: Instance) -> list[int]:
    """Indices of the positions y_1, z_1, y_2, ... in the states."""
    index = gear.component.declaration.index
    return [index[f"{axis}_{i}"] for i in range(1, 5) for axis in "yz"]


def on_seats(gear: Instance, seats: Seats | None, damping: float = 1.0) -> Rhs:
    """State derivatives of the gear pair, its bearing forces following its motion."""
    index = gear.component.declaration.index
    bonds = [
        (index[name], at, k, damping * c)
        for at, (name, k, c) in zip(positions(gear), seats.bonds if seats else (), strict=False)
    ]
    rhs, block = gear.component.kernels.rhs, gear.block
    dx = np.empty(STATES)

    def derivative(x: np.ndarray) -> np.ndarray:
        block[:STATES] = x
        for force, s, k, c in bonds:
            block[force] = -k * x[s] - c * x[s + 12]
        rhs(block, 0.0, dx)
        return dx.copy()

    return derivative


SIZES = np.array([1e-8] * 8 + [1e-7, 1e-7, 1e-8, 1e-7] + [1e-4] * 8 + [1e-3, 1e-3, 1e-4, 1e-3])
"""Steps of a central difference, by state; small against the mesh deflection of 2e-6 m."""


def linearise(derivative: Rhs, x: np.ndarray) -> np.ndarray:
    """Jacobian of the state derivatives, by central differences."""
    columns = []
    for i, size in enumerate(SIZES):
        d = np.zeros(STATES)
        d[i] = size
        columns.append((derivative(x + d) - derivative(x - d)) / (2 * size))
    return np.array(columns).T


def equilibrium(
    gear: Instance, seats: Seats | None, torque: float = 200.0, angle: float = 0.0
) -> np.ndarray:
    """States at rest under `torque` on the pinion; also sets the torque on the wheel.

    That is the ratio of the base radii but for the energy that the meshes take up over their phase.
    """
    gear.set("pinion.tau", torque)
    gear.set("wheel.tau", -torque * gear["wheel.base_radius"] / gear["pinion.base_radius"])
    index = gear.component.declaration.index
    derivative = on_seats(gear, seats)
    x = np.zeros(STATES)
    x[index["approach"]] = 3e-6
    x[index["angle"]] = angle
    free = [i for i in range(12) if i != index["angle"]]
    for _ in range(30):
        here, tau = derivative(x), gear["wheel.tau"]
        gear.set("wheel.tau", tau + 1.0)
        of_torque = (derivative(x) - here)[12:, None]
        gear.set("wheel.tau", tau)
        jacobian = np.hstack([linearise(derivative, x)[12:, free], of_torque])
        scale = np.abs(jacobian).max(axis=0)
        step = np.linalg.lstsq(jacobian / scale, -here[12:], rcond=1e-13)[0] / scale
        x[free] += step[:-1]
        gear.set("wheel.tau", tau + step[-1])
        if np.abs(step[:-1]).max() < 1e-19:
            break
    return x


def set_states(gear: Instance, x: np.ndarray) -> None:
    gear.block[:STATES] = x
    gear.component.kernels.out(gear.block, 0.0)


def loaded(
    gear: Instance, torque: float = 200.0, speed: float = 0.0, angle: float = 0.0
) -> np.ndarray:
    """Static equilibrium under torque and constant bearing forces; also sets these inputs."""
    seats = Seats()
    x = equilibrium(gear, seats, torque, angle)
    for (name, k, _), i in zip(seats.bonds, [0, 4, 1, 5, 2, 6, 3, 7], strict=True):
        gear.set(name, -k * x[i])
    x[INDEX["der(angle)"]] = speed
    set_states(gear, x)
    return x


def rhs(gear: Instance, x: np.ndarray) -> np.ndarray:
    dx = np.empty(STATES)
    gear.block[:STATES] = x
    gear.component.kernels.rhs(gear.block, 0.0, dx)
    return dx


def random_state(seed: int) -> np.ndarray:
    """Microns and mm/s around a loaded position; angle and speed of any size."""
    random = np.random.default_rng(seed)
    x = 1e-6 * random.standard_normal(STATES)
    x[INDEX["approach"]] += 4e-6
    x[12:] *= 1e3
    x[INDEX["angle"]], x[INDEX["der(angle)"]] = random.uniform(-7, 7), random.uniform(-200, 200)
    return x


def mesh_force(gear: Instance, deflection: float, rate: float = 0.0, angle: float = 0.0) -> float:
    """Normal force of the left mesh at a deflection [m] and rate [m/s], rolled by the approach."""
    c = math.cos(gear["base_helix_angle"])
    x = np.zeros(STATES)
    x[INDEX["approach"]], x[INDEX["der(approach)"]] = deflection / c, rate / c
    x[INDEX["angle"]] = angle
    set_states(gear, x)
    assert gear["mesh_left.deflection"] == pytest.approx(deflection, rel=1e-14)
    return gear["mesh_left.force"]

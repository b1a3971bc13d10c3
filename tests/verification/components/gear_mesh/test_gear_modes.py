"""Natural frequencies and damping ratios of the linear gear pair.

Numbers without another source come from the project's physics notes ("physics"), which list what an
independent prototype of the same equations found.
"""

import math

import numpy as np
from scipy.linalg import eigh
from support.gearing.gear_mesh import (
    AXIAL_STIFFNESS,
    INDEX,
    MESH_STIFFNESS,
    RADIAL_STIFFNESS,
    UNDAMPED,
    Seats,
    equilibrium,
    gear_pair,
    linearise,
    loaded,
    on_seats,
    rhs,
)

from herringbone.core import Instance

# physics 2.4: undamped frequency, and damping ratio of the damped mode.
MODES = [
    (305.1, 0.019), (563.1, 0.019), (899.0, 0.025), (1293.8, 0.019), (3432.1, 0.104), (6102, 0.031),
    (7669.5, 0.039), (7932.8, 0.033), (8548.6, 0.028), (11454, 0.023), (13565, 0.021),
]  # fmt: skip


def system_matrices(gear: Instance) -> tuple[np.ndarray, np.ndarray]:
    """Mass and stiffness in y1 z1 th1 ... th4, assembled here from springs (virtual work)."""
    p = {
        g: {n: gear[f"{g}.{n}"] for n in ("mass", "inertia", "base_radius")}
        for g in ("pinion", "wheel")
    }
    mass, stiffness = np.zeros((2, 12, 12))
    for body in range(4):
        gear_name = ("pinion", "pinion", "wheel", "wheel")[body]
        m, i = p[gear_name]["mass"], p[gear_name]["inertia"]
        mass[3 * body : 3 * body + 3, 3 * body : 3 * body + 3] = np.diag([m, m, i])

    def spring(row: np.ndarray, k: float) -> None:
        stiffness[:] += k * np.outer(row, row)

    unit = np.eye(12)
    for first, gear_name in ((0, "pinion"), (6, "wheel")):
        for axis, letter in enumerate("yzt"):
            k = gear[f"{gear_name}.shaft_stiffness_{letter}"]
            spring(unit[first + axis] - unit[first + 3 + axis], k)
        for half in (first, first + 3):
            spring(unit[half], RADIAL_STIFFNESS)
            spring(unit[half + 1], AXIAL_STIFFNESS if gear_name == "wheel" else 0.0)
    c, s = math.cos(gear["base_helix_angle"]), math.sin(gear["base_helix_angle"])
    for side, sign in ((0, 1), (3, -1)):
        row = np.zeros(12)
        row[side : side + 3] = c, sign * s, c * p["pinion"]["base_radius"]
        row[6 + side : 9 + side] = -c, -sign * s, -c * p["wheel"]["base_radius"]
        spring(row, MESH_STIFFNESS / 2)
    return mass, stiffness


def undamped_frequencies(table) -> tuple[np.ndarray, Instance]:
    gear = gear_pair(table, UNDAMPED)
    x = equilibrium(gear, Seats())
    matrix = linearise(on_seats(gear, Seats(), damping=0.0), x)
    squares = np.sort(np.linalg.eigvals(-matrix[12:, :12]).real)
    assert abs(squares[0]) < 1e-6 * squares[1]  # rigid rotation
    return np.sqrt(squares[1:]) / (2 * np.pi), gear


def test_natural_frequencies_of_the_notes(constant):
    found, _ = undamped_frequencies(constant)
    np.testing.assert_allclose(found, [f for f, _ in MODES], rtol=1e-3)  # parameters: 4 digits


def test_natural_frequencies_of_matrices_assembled_here(constant):
    found, gear = undamped_frequencies(constant)
    mass, stiffness = system_matrices(gear)
    squares = eigh(stiffness, mass, eigvals_only=True)
    # Differences over 1e-8 m in forces of 4e3 N: 1e-16 * 4e3 / (1e-8 * 1e9) = 4e-14, times n.
    np.testing.assert_allclose(found, np.sqrt(squares[1:]) / (2 * np.pi), rtol=1e-9)


def test_damping_ratios(constant):
    gear = gear_pair(constant)
    seats = Seats()
    values = np.linalg.eigvals(linearise(on_seats(gear, seats), equilibrium(gear, seats)))
    values = values[values.imag > 1.0]
    values = values[np.argsort(np.abs(values))]
    # The notes give three decimals.
    np.testing.assert_allclose(-values.real / np.abs(values), [z for _, z in MODES], atol=5.1e-4)


def test_rigid_rotation_is_a_null_vector(constant):
    gear = gear_pair(constant)
    x = loaded(gear)
    turned = x.copy()
    turned[INDEX["angle"]] += 1.234
    np.testing.assert_array_equal(rhs(gear, turned), rhs(gear, x))

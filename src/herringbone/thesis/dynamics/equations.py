"""The thesis' twelve equations without damping as matrices: corrected, and as they are printed.

Order: y, z, theta of pinion left, pinion right, wheel left, wheel right. Printed (chapter 3.2), the
equations have, against those that follow from virtual work,

- no stiffness of the gaps between left and right halves, in bending and torsion,
- a spring k_z13 between pinion and wheel of the same side in place of that of the gap,
- the helix angle in place of that on the base cylinder.

The mesh's subscripts 1 and 2 are read as 1 and 3: with 2, which is the right half of the pinion,
the pinion would mesh with itself.
"""

import numpy as np

from herringbone.analysis.anatomy import value_at
from herringbone.core.declaring.roles import GEARS
from herringbone.running.loading import load_system
from herringbone.thesis import names
from herringbone.thesis.pair.given import JOB

PUBLISHED_STIFFNESS = 2.011e9
"""Mean mesh stiffness of both halves without relief, chapter 2.4 [N/m]."""
BODIES = ("pinion left", "pinion right", "wheel left", "wheel right")
COORDINATES = tuple(f"{body} {q}" for body in BODIES for q in ("y", "z", "θ"))
_SIDES = ((0, 2, 1.0), (1, 3, -1.0))
"""Pinion, wheel and hand of the left and of the right mesh."""


class Bodies:
    """Masses, stiffnesses and base radii as the shipped system has them, SI units."""

    def __init__(self) -> None:
        system, _ = load_system(names.ON_GROUND)

        def of(part: str, what: str) -> tuple[float, ...]:
            return tuple(value_at(system, f"{part}.{gear}.{what}") for gear in GEARS)

        self.mass, self.inertia = of(names.GEAR, "mass"), of(names.GEAR, "inertia")
        self.base_radius = of(names.GEAR, "base_radius")
        self.gap = tuple(of(names.GEAR, f"shaft_stiffness_{q}") for q in "yzt")
        self.radial = of(names.BEARINGS, "radial_stiffness")
        self.axial = of(names.BEARINGS, "axial_stiffness")
        self.base_helix_angle = value_at(system, f"{names.GEAR}.base_helix_angle")


def mass_matrix(bodies: Bodies) -> np.ndarray:
    """(12, 12) [kg], [kg m2]."""
    each = [(bodies.mass[g], bodies.mass[g], bodies.inertia[g]) for g in (0, 0, 1, 1)]
    return np.diag(np.concatenate(each))


def corrected(bodies: Bodies, stiffness: float) -> np.ndarray:
    """Stiffness matrix (12, 12) by virtual work, with the mesh stiffness of both halves [N/m]."""
    k = _grounded(bodies) + _mesh(bodies, stiffness, bodies.base_helix_angle)
    for gear in (0, 1):
        left, right = 6 * gear, 6 * gear + 3
        for q in range(3):
            _join(k, left + q, right + q, bodies.gap[q][gear])
    return k


def printed(bodies: Bodies, stiffness: float) -> np.ndarray:
    """As printed; k_z13, which has no value, is the only axial stiffness of table 3.1."""
    k = _grounded(bodies) + _mesh(bodies, stiffness, JOB.pair.helix_angle)
    for pinion, wheel, _ in _SIDES:
        _join(k, 3 * pinion + 1, 3 * wheel + 1, bodies.axial[1])
    return k


def frequencies(stiffness: np.ndarray, mass: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Natural frequencies (12,) [Hz], and shares (12 coordinates, 12) of the kinetic energy."""
    root = 1.0 / np.sqrt(np.diag(mass))
    squares, shapes = np.linalg.eigh(root[:, None] * stiffness * root)
    rigid = 1e-9 * squares.max()
    return np.sqrt(np.where(squares > rigid, squares, 0.0)) / (2.0 * np.pi), shapes**2


def _grounded(bodies: Bodies) -> np.ndarray:
    k = np.zeros((12, 12))
    for body in range(4):
        k[3 * body, 3 * body] = bodies.radial[body // 2]
        k[3 * body + 1, 3 * body + 1] = bodies.axial[body // 2]
    return k


def _mesh(bodies: Bodies, stiffness: float, helix_angle: float) -> np.ndarray:
    k = np.zeros((12, 12))
    for pinion, wheel, hand in _SIDES:
        row = np.zeros(12)
        for body, gear, sign in ((pinion, 0, 1.0), (wheel, 1, -1.0)):
            along = sign * np.cos(helix_angle)
            row[3 * body : 3 * body + 3] = (
                along, sign * hand * np.sin(helix_angle), along * bodies.base_radius[gear],
            )  # fmt: skip
        k += 0.5 * stiffness * np.outer(row, row)
    return k


def _join(k: np.ndarray, one: int, other: int, stiffness: float) -> None:
    k[np.ix_([one, other], [one, other])] += stiffness * np.array([[1.0, -1.0], [-1.0, 1.0]])

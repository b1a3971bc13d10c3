"""What each mode of a housing does: shares of its kinetic and of its strain energy.

The kinetic energy of the box, which is all above the base plate, is split into the six motions of a
rigid body about its center of mass and the rest, which is elastic. The best-fitting rigid motion
R c solves (R^T M R) c = R^T M u; M is the consistent mass matrix of the box. Shares of motions that
are coupled by products of inertia, which are small here, are half and half.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import scipy.sparse as sp

from herringbone.housing.welded.finite_elements import FiniteElements

RIGID_MOTIONS = ("Tx", "Ty", "Tz", "Rx", "Ry", "Rz")
"""Translations along, and rotations about, x (toward the wheel), y (up) and z (axial)."""
_BASE = "base plate"


@dataclass(frozen=True)
class ModeShares:
    """Energy shares of modes [1].

    Attributes:
        frequency_hz: (m,) [Hz].
        rigid: (m, 6) of the kinetic energy, by `RIGID_MOTIONS` of the box.
        elastic: (m,) of the kinetic energy, in the elastic motion of the box.
        base: (m,) of the kinetic energy, in the base plate.
        strain: by plate, (m,) of the strain energy.
    """

    motions: ClassVar[tuple[str, ...]] = RIGID_MOTIONS

    frequency_hz: np.ndarray
    rigid: np.ndarray
    elastic: np.ndarray
    base: np.ndarray
    strain: dict[str, np.ndarray]


def mode_shares(model: FiniteElements, frequency_hz: np.ndarray, shapes: np.ndarray) -> ModeShares:
    """Energy shares of some modes.

    Args:
        model: the housing.
        frequency_hz: (m,) of the modes [Hz].
        shapes: (f, m) of the free unknowns, mass-normalised [kg^-1/2].
    """
    u, plates = model.full(shapes), model.plates()
    strain = {
        name: _quadratic(model.solid.stiffness(elements), u) for name, elements in plates.items()
    }
    total = sum(strain.values())
    above = np.concatenate([elements for name, elements in plates.items() if name != _BASE])
    box = model.solid.mass(above)
    rigid = _rigid_energy(box, _rigid_motions(box, model.solid.nodes), u)
    moving = _quadratic(box, u)
    base = _quadratic(model.solid.mass(plates[_BASE]), u)
    kinetic = moving + base
    return ModeShares(
        frequency_hz,
        (rigid / kinetic).T,
        (moving - rigid.sum(axis=0)) / kinetic,
        base / kinetic,
        {name: energy / total for name, energy in strain.items()},
    )


def _quadratic(matrix: sp.csr_array, u: np.ndarray) -> np.ndarray:
    """u^T A u of each column."""
    return np.einsum("ij,ij->j", u, matrix @ u)


def _rigid_motions(mass: sp.csr_array, nodes: np.ndarray) -> np.ndarray:
    """Motions (3 n, 6) of a rigid body, rotations about the center of mass."""
    count = len(nodes)
    weights = mass[:count, :count].sum(axis=1)
    x, y, z = (nodes - weights @ nodes / weights.sum()).T
    motions = np.zeros((3, count, 6))
    for axis in range(3):
        motions[axis, :, axis] = 1.0
    motions[1, :, 3], motions[2, :, 3] = -z, y
    motions[0, :, 4], motions[2, :, 4] = z, -x
    motions[0, :, 5], motions[1, :, 5] = -y, x
    return motions.reshape(3 * count, 6)


def _rigid_energy(mass: sp.csr_array, motions: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Energies (6, m) of the best-fitting rigid motions."""
    inertia = motions.T @ (mass @ motions)
    momentum = motions.T @ (mass @ u)
    return np.linalg.solve(inertia, momentum) * momentum

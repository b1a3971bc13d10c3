"""The gear pair with its meshes frozen at an operating point, as linear analysis takes it.

At the operating point each mesh has a normal force N, a deflection d and, over a mesh period,
tangent stiffnesses. The frozen mesh keeps the operating point and has one stiffness K:

    F(p, deflection) = N + K (deflection - d),    deflection >= d / 2

so that the states at which the mesh was frozen are still an equilibrium. The axial offset of the
chevron's apex stays at its value, and the meshing impact is off.
"""

from collections.abc import Callable

import numpy as np

from herringbone.core import Instance, ParameterError
from herringbone.core.roles import SIDES
from herringbone.kernels import force_law

_LAST = force_law.DEFLECTIONS - 1


def tangent_stiffness(gear: Instance, side: int) -> np.ndarray:
    """Tangent stiffness [N/m] of mesh 0 (left) or 1 (right) over a period, at its deflection."""
    deflection = gear[f"mesh_{SIDES[side]}.deflection"]
    table = _table(gear, side)
    phases = np.arange(force_law.PHASES) / force_law.PHASES
    return np.array([force_law.law(gear.block, table, p, deflection)[1] for p in phases])


def freeze_mesh(gear: Instance, stiffness: Callable[[np.ndarray], float]) -> None:
    """Replace the force laws of a gear pair by straight lines through its operating point.

    Args:
        gear: at the operating point.
        stiffness: makes one stiffness [N/m] of the tangents over a mesh period.

    Raises:
        ParameterError: a mesh is open at the operating point.
    """
    offset, share = gear["axial_offset"], gear["symmetry_deviation"]
    for side, name in enumerate(SIDES):
        deflection, force = gear[f"mesh_{name}.deflection"], gear[f"mesh_{name}.force"]
        if deflection <= 0.0 or force <= 0.0:
            raise ParameterError(
                f"{gear.name}: the {name} mesh is open (deflection {deflection:g} m) where "
                "stability is wanted; choose a scene that starts in equilibrium under load"
            )
        tangent = stiffness(tangent_stiffness(gear, side))
        _write_line(gear.block, _table(gear, side), deflection, force, tangent)
    index = gear.component.declaration.index
    gear.block[index["impact_force"]] = 0.0
    gear.block[index["symmetry_pinion"]] = gear.block[index["symmetry_wheel"]] = 0.0
    gear.block[index["symmetry_constant"]] = offset / share if share else 0.0


def _table(gear: Instance, side: int) -> int:
    return gear.component.declaration.first_table + side * force_law.TABLE_SIZE


def _write_line(
    block: np.ndarray, at: int, deflection: float, force: float, tangent: float
) -> None:
    """Table part whose law above half the deflection is a line; below, the secant is constant."""
    limit = 0.5 * deflection
    secant = (force - tangent * (deflection - limit)) / limit
    block[at : at + force_law.TABLE_SIZE] = 0.0
    block[at], block[at + 1] = limit, 0.0
    nodes = block[at + 2 : at + force_law.TABLE_SIZE].reshape(force_law.PHASES, -1, force_law.NODE)
    nodes[:, :, 0] = secant
    nodes[:, _LAST, 2] = (tangent - secant) / (0.5 * _LAST)

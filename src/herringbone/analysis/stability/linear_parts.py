"""A system as linear parts: components in this process at an operating point, the mesh frozen.

At the operating point each mesh has a normal force N, a deflection d and, over a mesh period, a
tangent stiffness K between a minimum and a maximum. The frozen mesh keeps the operating point and
has one K:

    F(p, deflection) = N + K (deflection - d),    deflection >= d / 2

so that the states at which the mesh was frozen are still an equilibrium. The axial offset of the
chevron's apex stays at its value, and the meshing impact is off. Then everything is affine while
the mesh stays closed and no limit of a motor acts.
"""

from collections.abc import Sequence
from enum import StrEnum

import numpy as np

from herringbone.analysis.twin.monolithic import make_instances
from herringbone.components.gear_mesh import GEAR_MESH
from herringbone.components.in_process import InProcessPart
from herringbone.core import Instance, ParameterError
from herringbone.cosim.structure.network import Network, build_network
from herringbone.cosim.structure.system import System
from herringbone.kernels import force_law

_SIDES = ("left", "right")
_LAST = force_law.DEFLECTIONS - 1


class MeshStiffness(StrEnum):
    """Which tangent stiffness of a mesh period is taken."""

    MINIMUM = "minimum"
    MEAN = "mean"
    MAXIMUM = "maximum"

    def of(self, values: np.ndarray) -> float:
        """The minimum, mean or maximum of stiffnesses over a mesh period."""
        return float({"minimum": np.min, "mean": np.mean, "maximum": np.max}[self](values))


def linear_network(
    system: System, stiffness: MeshStiffness = MeshStiffness.MEAN
) -> tuple[Network, list[Instance]]:
    """Parts of a system at its start values, linear.

    Args:
        system: of components of this package; its start values are an equilibrium.
        stiffness: at which all meshes are frozen.

    Raises:
        StructureError: a part is a foreign FMU, or the connections are wrong.
        ParameterError: a mesh is open, or a value is wrong.
    """
    instances = make_instances(system)
    network = build_network(system, [InProcessPart(i) for i in instances])
    _propagate(network, instances)
    for instance in instances:
        if instance.component is GEAR_MESH:
            freeze_mesh(instance, stiffness)
    return network, instances


def _propagate(network: Network, instances: Sequence[Instance]) -> None:
    """Outputs of elements from the bodies' motions, and of bodies from the elements' forces."""
    for target in (*network.elements, *network.bodies):
        for c in network.inputs(target):
            instances[target].set(c.input, instances[c.source][c.output])
        instances[target].component.kernels.out(instances[target].block, 0.0)


def tangent_stiffness(gear: Instance, side: int) -> np.ndarray:
    """Tangent stiffness [N/m] of mesh 0 (left) or 1 (right) over a period, at its deflection."""
    deflection = gear[f"mesh_{_SIDES[side]}.deflection"]
    table = _table(side)
    phases = np.arange(force_law.PHASES) / force_law.PHASES
    return np.array(
        [force_law.force_and_tangent(gear.block, table, p, deflection)[1] for p in phases]
    )


def freeze_mesh(gear: Instance, stiffness: MeshStiffness) -> None:
    """Replace the force laws of a gear pair by straight lines through its operating point.

    Raises:
        ParameterError: a mesh is open at the operating point.
    """
    offset, share = gear["axial_offset"], gear["symmetry_deviation"]
    for side, name in enumerate(_SIDES):
        deflection, force = gear[f"mesh_{name}.deflection"], gear[f"mesh_{name}.force"]
        if deflection <= 0.0 or force <= 0.0:
            raise ParameterError(
                f"{gear.name}: the {name} mesh is open (deflection {deflection:g} m) where "
                "stability is wanted; choose a scene that starts in equilibrium under load"
            )
        tangent = stiffness.of(tangent_stiffness(gear, side))
        _write_line(gear.block, _table(side), deflection, force, tangent)
    index = GEAR_MESH.declaration.index
    gear.block[index["impact_force"]] = 0.0
    gear.block[index["symmetry_pinion"]] = gear.block[index["symmetry_wheel"]] = 0.0
    gear.block[index["symmetry_constant"]] = offset / share if share else 0.0


def _table(side: int) -> int:
    return GEAR_MESH.declaration.first_table + side * force_law.TABLE_SIZE


def _write_line(
    block: np.ndarray, at: int, deflection: float, force: float, tangent: float
) -> None:
    """Table part whose law above half the deflection is a line; below, the secant is constant."""
    limit = 0.5 * deflection
    secant = (force - tangent * (deflection - limit)) / limit
    block[at : at + force_law.TABLE_SIZE] = 0.0
    block[at], block[at + 1] = limit, 0.0
    nodes = block[at + 2 : at + force_law.TABLE_SIZE].reshape(force_law.PHASES, -1, 4)
    nodes[:, :, 0] = secant
    nodes[:, _LAST, 2] = (tangent - secant) / (0.5 * _LAST)

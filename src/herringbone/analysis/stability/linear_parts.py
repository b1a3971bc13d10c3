"""A system as linear parts: components in this process at an operating point, meshes frozen.

Laws that change with the phase of a mesh are frozen by the components that have them (`freeze`), at
one tangent stiffness of a mesh period. Then everything is affine while meshes stay closed and no
limit of a motor acts.
"""

from collections.abc import Callable, Sequence
from enum import StrEnum

import numpy as np

from herringbone.analysis.twin.monolithic import make_instances
from herringbone.components.in_process import InProcessPart
from herringbone.core import Instance
from herringbone.cosim.structure.network import Network, build_network
from herringbone.cosim.structure.system import System


class MeshStiffness(StrEnum):
    """Which tangent stiffness of a mesh period is taken."""

    MINIMUM = "minimum"
    MEAN = "mean"
    MAXIMUM = "maximum"

    def of(self, values: np.ndarray) -> float:
        """The minimum, mean or maximum of stiffnesses over a mesh period."""
        kinds: dict[str, Callable] = {"minimum": np.min, "mean": np.mean, "maximum": np.max}
        return float(kinds[self](values))


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
        if instance.component.freeze:
            instance.component.freeze(instance, stiffness.of)
    return network, instances


def _propagate(network: Network, instances: Sequence[Instance]) -> None:
    """Outputs of elements from the bodies' motions, and of bodies from the elements' forces."""
    for target in (*network.elements, *network.bodies):
        for c in network.inputs(target):
            instances[target].set(c.input, instances[c.source][c.output])
        instances[target].component.kernels.out(instances[target].block, 0.0)

"""A system as linear parts: components in this process at an operating point, meshes frozen.

Foreign parts are those that were identified, each in the place of the real one.

Laws that change with the phase of a mesh are frozen by the components that have them (`freeze`), at
one tangent stiffness of a mesh period. Then everything is affine while meshes stay closed and no
limit of a motor acts.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from enum import StrEnum

import numpy as np

from herringbone.analysis.stability.surrogates.stand_in import StandIn, Stranger
from herringbone.analysis.twin.monolithic import make_instances
from herringbone.components.in_process import InProcessPart
from herringbone.core import Instance
from herringbone.core.part import Part
from herringbone.core.places.part_path import PartPath
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


Member = Instance | StandIn
"""A part of a linear system."""
Strangers = Mapping[str, Stranger]
"""What stands for foreign parts, by name."""
NO_STRANGERS: Strangers = {}


def linear_network(
    system: System,
    stiffness: MeshStiffness = MeshStiffness.MEAN,
    strangers: Strangers = NO_STRANGERS,
) -> tuple[Network, list[Member]]:
    """Parts of a system at its start values, linear.

    Args:
        system: its start values are an equilibrium.
        stiffness: at which all meshes are frozen.
        strangers: what stands for its foreign parts, all with a model.

    Raises:
        StructureError: nothing stands for a foreign part, or the connections are wrong.
        ParameterError: a mesh is open, or a value is wrong.
    """
    return _frozen(system, strangers, stiffness.of)


def stiffest_mesh(system: System, strangers: Strangers = NO_STRANGERS) -> float:
    """Largest stiffness of a mesh over its mean, of all meshes; raises as `linear_network`.

    Returns:
        1.0 if there is no mesh.
    """
    found = [1.0]

    def recorded(values: np.ndarray) -> float:
        found.append(float(np.max(values) / np.mean(values)))
        return float(np.mean(values))

    _frozen(system, strangers, recorded)
    return max(found)


def _frozen(
    system: System, strangers: Strangers, stiffness: Callable[[np.ndarray], float]
) -> tuple[Network, list[Member]]:
    """See `linear_network`; `stiffness` chooses from the stiffnesses of a mesh over its period."""
    network, members = network_at_start(system, strangers)
    for member in members:
        if isinstance(member, Instance) and member.component.freeze:
            member.component.freeze(member, stiffness)
    return network, members


def network_at_start(system: System, strangers: Strangers) -> tuple[Network, list[Member]]:
    """See `linear_network`; with laws as they are, so that meshes may be open."""
    own = _own_instances(system, strangers)
    members: list[Member] = [
        StandIn(strangers[spec.name]) if spec.name in strangers else own[spec.name]
        for spec in system.parts
    ]
    parts = [InProcessPart(m) if isinstance(m, Instance) else m.part for m in members]
    network = build_network(system, parts)
    _propagate(network, members)
    return network, members


def linear_instances(system: System) -> list[Instance]:
    """Parts of a system without foreign ones, as `linear_network` has them."""
    return [member for member in linear_network(system)[1] if isinstance(member, Instance)]


def real_parts(system: System, strangers: Strangers = NO_STRANGERS) -> list[Instance | Part]:
    """Parts of a system at its start values, for a run: instances, and fresh foreign parts.

    Raises:
        HerringboneError: nothing stands for a foreign part, or a value is wrong.
    """
    own = _own_instances(system, strangers)
    return [
        strangers[spec.name].fresh() if spec.name in strangers else own[spec.name]
        for spec in system.parts
    ]


def _own_instances(system: System, strangers: Strangers) -> dict[PartPath, Instance]:
    parts = tuple(spec for spec in system.parts if spec.name not in strangers)
    made = make_instances(replace(system, parts=parts, connections=()))
    return {spec.name: instance for spec, instance in zip(parts, made, strict=True)}


def _propagate(network: Network, members: Sequence[Member]) -> None:
    """Outputs of elements from the bodies' motions, and of bodies from the elements' forces.

    What foreign parts feed stays as it is: the equilibrium was found without them.
    """
    for target in (*network.elements, *network.bodies):
        member = members[target]
        if not isinstance(member, Instance):
            continue
        for c in network.inputs(target):
            source = members[c.source]
            if isinstance(source, Instance):
                member.set(c.input, source[c.output])
        member.component.kernels.out(member.block, 0.0)

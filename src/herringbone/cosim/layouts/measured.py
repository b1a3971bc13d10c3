"""The signals by whose errors an adaptive step is measured, and what is measured together."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from herringbone.core.part import column
from herringbone.core.places.part_path import PartPath, in_groups
from herringbone.cosim.layouts.layout import connected_outputs
from herringbone.cosim.layouts.nodes import NodeLayout
from herringbone.cosim.structure.network import Network


class Measured(NamedTuple):
    """Signals and groups of them; a signal may be in several.

    Attributes:
        output: the unknowns, then channels that are none.
        held: 1 for unknowns that a body holds over the step.
        member, group: pairs of a signal and a group that it is in.
        members: how many by group: the unknowns by their units, then the channels.
        units: how many groups are of unknowns.
    """

    output: np.ndarray
    held: np.ndarray
    member: np.ndarray
    group: np.ndarray
    members: np.ndarray
    units: int


def measured_signals(
    nodes: NodeLayout, held: np.ndarray, channels: Sequence[np.ndarray] = ()
) -> Measured:
    """The unknowns, and channels.

    Args:
        nodes: the layout of passes.
        held: see `Measured`; of the unknowns.
        channels: outputs of each group, at least one.
    """
    more = np.setdiff1d(np.concatenate([nodes.unknown[:0], *channels]), nodes.unknown)
    output = np.concatenate([nodes.unknown, more])
    place = {int(i): k for k, i in enumerate(output)}
    units = int(nodes.group.max(initial=-1)) + 1
    member, group = list(range(nodes.unknown.size)), nodes.group.tolist()
    for g, outputs in enumerate(channels, units):
        member += [place[int(i)] for i in outputs]
        group += [g] * outputs.size
    return Measured(
        output=output,
        held=np.concatenate([held, 0 * more]),
        member=np.array(member, dtype=np.int64),
        group=np.array(group, dtype=np.int64),
        members=np.bincount(group, minlength=units + len(channels)).astype(np.float64),
        units=units,
    )


def channel_outputs(
    network: Network, channels: Mapping[str, Sequence[str]]
) -> dict[str, np.ndarray]:
    """Outputs that the loop reads, of each group of channels of which a part takes any.

    Args:
        network: parts and connections.
        channels: patterns of columns by group.
    """
    names = [
        column(part, name)
        for part, own in zip(network.parts, connected_outputs(network), strict=True)
        for name in own
    ]
    place = {name: i for i, name in enumerate(names)}
    found = in_groups([PartPath(part.name) for part in network.parts], names, channels)
    return {
        group: np.array([place[name] for name in own], dtype=np.int64)
        for group, own in found.items()
    }

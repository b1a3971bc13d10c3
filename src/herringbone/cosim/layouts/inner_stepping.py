"""The bodies' own steps inside of macro steps, and how the loop may lengthen them."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from herringbone.cosim.structure.network import Network

TO_BE, ARE = range(2)
"""Places in `Lengthened.times`."""


class InnerStepping(NamedTuple):
    """What a run's inner steps are.

    Attributes:
        longest: of the bodies [s]; 0 if there is none, or unknown.
        parameters: `part.parameter` that bound them, tunable, with their values [s], which the loop
            may lengthen all alike where little of the tolerance is taken by them.
        most: times that they are lengthened at the most [1].
    """

    longest: float = 0.0
    parameters: Mapping[str, float] = MappingProxyType({})
    most: float = 1.0


NO_INNER = InnerStepping()


class Lengthened(NamedTuple):
    """Inner steps in an adaptive loop.

    Attributes:
        longest: of the bodies in ticks, if nothing is lengthened; 0 if they make none.
        most: see `InnerStepping`.
        part, reference, step: parameters, and their values [s].
        value: (1,) room.
        times: (2,) that they are to be lengthened; that they are.
    """

    longest: float
    most: float
    part: np.ndarray
    reference: np.ndarray
    step: np.ndarray
    value: np.ndarray
    times: np.ndarray


def lengthened(network: Network, inner: InnerStepping, tick: float) -> Lengthened:
    """Inner steps as they are at the start.

    Args:
        network: parts and connections.
        inner: what they are.
        tick: in which macro steps are counted [s].
    """
    index = {part.name: p for p, part in enumerate(network.parts)}
    places = [
        (index[path.rpartition(".")[0]], path.rpartition(".")[2]) for path in inner.parameters
    ]
    return Lengthened(
        longest=inner.longest / tick,
        most=inner.most,
        part=np.array([p for p, _ in places], dtype=np.int64),
        reference=np.array(
            [network.parts[p].variables[name].reference for p, name in places], dtype=np.uint32
        ),
        step=np.array(list(inner.parameters.values())),
        value=np.zeros(1),
        times=np.ones(2),
    )

"""Outputs of foreign parts that are looked at for jumps inside a macro step."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from herringbone.core.part import of_parts
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.repeating import answers_again, explicit_parts

if TYPE_CHECKING:
    from herringbone.cosim.signature.signature import Signature

LOWEST_DEGREE = 3
"""Of polynomials whose differences tell a smooth output from others: they fall with this power."""


class Jumps(NamedTuple):
    """What is known of outputs that may jump, as contact or friction make them.

    Attributes:
        output: their numbers.
        group: number of each one's unit.
        weights: (p + 1,) of the values at the nodes, whose sum is the difference of order p.
        found: (2, outputs): that difference in the present step; the sum of the second ones.
        usual: (2, outputs): the same in the steps before.
        limit: (2, outputs): above which a step is taken back.
        largest: largest value of each unit so far.
        learns: 1 in whole macro steps, whose differences tell what is usual.
    """

    output: np.ndarray
    group: np.ndarray
    weights: np.ndarray
    found: np.ndarray
    usual: np.ndarray
    limit: np.ndarray
    largest: np.ndarray
    learns: np.ndarray


def lay_out_jumps(network: Network, degree: int, outputs: Sequence[Sequence[str]]) -> Jumps:
    """Outputs of foreign parts; none where steps cannot be taken back and divided.

    Args:
        network: parts and connections.
        degree: p.
        outputs: of each part that the loop reads.
    """
    keys = [(p, name) for p, names in enumerate(outputs) for name in names]
    foreign = [k for k, (p, _) in enumerate(keys) if _signature(network, p)]
    if degree < LOWEST_DEGREE or not _can_divide(network):
        foreign = []
    units = [str(network.parts[p].variables[name].unit) for p, name in (keys[k] for k in foreign)]
    count = len(foreign)
    return Jumps(
        output=np.array(foreign, dtype=np.int64),
        group=np.unique(np.array(units), return_inverse=True)[1].astype(np.int64),
        weights=np.array(
            [(-1.0) ** (degree - j) * math.comb(degree, j) for j in range(degree + 1)]
        ),
        found=np.zeros((2, count)),
        usual=np.zeros((2, count)),
        limit=np.zeros((2, count)),
        largest=np.zeros(max(1, count)),
        learns=np.ones(1, dtype=np.int64),
    )


def without(jumps: Jumps) -> Jumps:
    """The same, looking at nothing."""
    return jumps._replace(output=jumps.output[:0])


def _signature(network: Network, p: int) -> "Signature | None":
    """Of a foreign part."""
    return getattr(network.parts[p], "signature", None)


def _can_divide(network: Network) -> bool:
    """True if all parts can take a step back, and steps of any length in which they do the same.

    What parts fused into one do depends on how many of its own steps make a macro step.
    """
    parts = network.parts
    ticks = any(found.tick for p in range(len(parts)) if (found := _signature(network, p)))
    return (
        not network.slow
        and not explicit_parts(network)
        and not ticks
        and all(
            part.addresses.can_restore
            and not part.one_step
            and not of_parts(part)
            and not answers_again(part)
            for part in parts
        )
    )

"""Values that are not finite, or beyond all bounds: where, and whether the coupling made them."""

from collections.abc import Sequence

import numpy as np

from herringbone.core import HerringboneError
from herringbone.cosim.loops.common import BOUND
from herringbone.cosim.structure.network import Network

_AS_BEFORE, _FEWEST = 10.0, 8
"""What grows by the coupling passes this multiple of what it was in the first half of the rows."""


def diverged(network: Network, culprit: int) -> tuple[str, float]:
    """The first input or output of a part that has diverged, or the output that feeds it.

    Args:
        network: parts and connections.
        culprit: number of the part.

    Returns:
        Its name, "" if there is none, and its value.
    """
    parts = network.parts
    part = parts[culprit]
    names = [
        n for n, v in part.variables.items() if v.causality in {"output", "input"} and v.is_real
    ]
    try:
        found = zip(names, part.get(names), strict=True)
        bad, value = next(((n, x) for n, x in found if not abs(x) < BOUND), ("", 0.0))
        fed = bad.partition(".node")[0]
        for c in network.inputs(culprit):
            if c.input == fed and not abs(parts[c.source].get([c.output])[0]) < BOUND:
                return f"{parts[c.source].name}.{c.output}", value
    except HerringboneError:
        return "", 0.0
    return (f"{part.name}.{bad}", value) if bad else ("", 0.0)


def is_sudden(sizes: Sequence[tuple[int, np.ndarray]]) -> bool:
    """True if records end without having grown: then a part, and not the coupling, ends them so.

    Args:
        sizes: numbers of rows, ascending, and the magnitudes of all outputs in or up to these.
    """
    if not sizes or sizes[-1][0] + 1 < _FEWEST:
        return False
    number, last = sizes[-1]
    before = [size for k, size in sizes if 2 * k <= number] or [sizes[0][1]]
    return bool((last <= _AS_BEFORE * np.max(before, axis=0)).all())

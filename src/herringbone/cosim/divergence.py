"""Values that are not finite, or beyond all bounds: where, and whether the coupling made them."""

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


def is_sudden(values: np.ndarray) -> bool:
    """True if records end without having grown: then a part, and not the coupling, made it so.

    Args:
        values: (times, outputs) recorded; rows that are not finite are left out.
    """
    sizes = np.abs(values[np.isfinite(values).all(axis=1)])
    if len(sizes) < _FEWEST:
        return False
    before = sizes[: len(sizes) // 2].max(axis=0)
    return bool((sizes[-1] <= _AS_BEFORE * before).all())

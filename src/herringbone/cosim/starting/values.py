"""Outputs before the first step, where sources show other values after initialisation than in it.

Many FMUs show the start values of their outputs only after it. A part in step mode must not be set
and read without a step between, so that its outputs follow by the direct feedthrough D that trials
have found, y + D (u now - u of initialisation). A part that takes steps of one length only, and was
stepped before the run, begins with what its last step gave, on inputs that were held: its next one
gives such outputs, too.
"""

from collections.abc import Mapping

import numpy as np

from herringbone.core import FmuError
from herringbone.cosim.starting.approached_part import approached_of
from herringbone.cosim.structure.network import Network


def start_offsets(network: Network) -> Mapping[tuple[int, str], float]:
    """What the outputs of parts with a signature lack, by number of the part and name.

    Bodies, elements, and bodies again, as in initialisation. Zero is left out.

    Args:
        network: initialised, no part has stepped.
    """
    found: dict[tuple[int, str], float] = {}
    for p in (*network.bodies, *network.elements, *network.bodies):
        part = network.parts[p]
        before = approached_of(part)
        if before and before.first:
            names = list(before.first)
            shown = zip(names, part.get(names), strict=True)
            found |= {(p, n): before.first[n] - now for n, now in shown}
            continue
        signature = getattr(part, "signature", None)
        if signature is None:
            continue
        change = np.zeros(len(signature.inputs))
        for c in network.inputs(p):
            if c.input not in signature.inputs:
                continue
            now = network.parts[c.source].get([c.output])[0]
            now += found.get((c.source, c.output), 0.0)
            try:
                change[signature.inputs.index(c.input)] = now - part.get([c.input])[0]
            except FmuError:
                continue  # it does not show its inputs
        offsets = np.nan_to_num(signature.feedthrough) @ change
        found |= {(p, n): float(x) for n, x in zip(signature.outputs, offsets, strict=True)}
    return {key: offset for key, offset in found.items() if offset != 0.0}

"""What inputs take at the start that are opened because a part stays outside."""

import numpy as np

from herringbone.analysis.twin.composite_parts import Parts
from herringbone.analysis.twin.monolithic import Twin
from herringbone.cosim.structure.system import System


def feed_at_start(system: System, parts: Parts) -> str:
    """Set opened inputs to what the parts outside feed at the start.

    Args:
        system: the whole; what its foreign parts feed is not known, and stays as it is.
        parts: those inside; their blocks are changed.

    Returns:
        What a reader of the FMU should know of it; empty if nothing is fed from outside.

    Raises:
        StructureError, ParameterError, ResourceError: see `Twin`.
    """
    inside = {i.name: i for i in parts.instances}
    known = system.without(*system.foreign_parts)
    if len(known.parts) == len(inside):
        return ""
    twin = Twin(known)
    names = [i.name for i in twin.instances]
    fed = [
        c
        for c in twin.network.connections
        if names[c.target] in inside and names[c.source] not in inside
    ]
    columns = [f"{names[c.source]}.{c.output}" for c in fed]
    (values,) = twin.observe(np.zeros(1), twin.state[:, None], columns)
    for c, value in zip(fed, values, strict=True):
        inside[names[c.target]].set(c.input, float(value))
    sources = dict.fromkeys(c.source for c in fed)
    return "\n\n".join(_told(twin, p) for p in sources)


def _told(twin: Twin, source: int) -> str:
    """What must start as a part outside does, and by which of its parameters."""
    part, first = twin.instances[source], twin.layout.block_first[source]
    d = part.component.declaration
    text = (
        f"Inputs start with what {part.name} gives at the start; what takes its place must start "
        "there, too, or all will swing."
    )
    at_rest = [
        f"{v.name} = {twin.block[first + d.index[v.name]] + 0.0:.6g} {v.unit}"
        for v in d.parameters
        if v.at_rest
    ]
    if at_rest:
        text += f" {part.component.name} does so with\n    " + "\n    ".join(at_rest)
    return text

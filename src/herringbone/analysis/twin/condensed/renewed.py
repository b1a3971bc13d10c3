"""Modal coordinates of a system whose linear part is one that is known: only constants differ."""

from dataclasses import replace

import numpy as np

from herringbone.analysis.twin.condensed.equations import Equations
from herringbone.analysis.twin.condensed.modes import Modes
from herringbone.analysis.twin.monolithic import Twin

_MATRICES = ("a", "b", "c", "d", "e", "g")


def renewed(twin: Twin, equations: Equations, known: Equations, modes: Modes) -> Modes | None:
    """The modes of equations that differ from known ones by constants at most; None otherwise.

    Mean tangents stay what they were: whatever they are, the laws' values make up for it.

    Args:
        twin: of the new equations.
        equations: the new ones.
        known: to which the modes belong.
        modes: of these.
    """
    if (equations.laws, equations.signals) != (known.laws, known.signals):
        return None
    for name in _MATRICES:
        ours, theirs = getattr(equations, name), getattr(known, name)
        if name in {"b", "d", "g"}:
            ours, theirs = ours[:, :-1], theirs[:, :-1]
        if not np.array_equal(ours, theirs):
            return None
    moving = modes.back.any(axis=0) | modes.rigid.any(axis=1)
    x0, values = twin.state, len(modes.tangent)
    constant = np.where(moving, 0.0, x0)
    given = equations.b[:, -1] + equations.b[:, :values] @ modes.tangent @ equations.d[:, -1]
    a = equations.a + equations.b[:, :values] @ modes.tangent @ equations.c
    given += a @ constant
    references = list(modes.references)
    inputs, of_channels = modes.inputs.copy(), modes.of_channels.copy()
    inputs[:, -1] = modes.back @ (given - modes.rigid @ given[references])
    of_channels[:, -1] = equations.d[:, -1] + equations.c @ constant
    angles = x0[references]
    return replace(
        modes,
        inputs=inputs,
        of_channels=of_channels,
        constant=constant,
        start=modes.back @ (x0 - modes.rigid @ angles),
        angles=angles,
    )

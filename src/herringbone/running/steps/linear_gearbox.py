"""Own parts of a system, linear: as they start, or each gearbox by itself under a torque.

Where the system's start is no load, or foreign parts take part, gear pair, bearings and housing of
each gearbox are looked at alone.
"""

from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.stability.linear_parts import Member, linear_network
from herringbone.core import HerringboneError, Instance, ParameterError
from herringbone.core.declaring.roles import Role
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.system import System
from herringbone.running.pairs.carrying_flank import loaded_start
from herringbone.running.pairs.open_flanges import loaded

STABLE = 2.5
"""Step of classical Runge-Kutta times frequency: 2.8 is the limit."""
_BOX = frozenset({Role.GEAR_PAIR, Role.BEARING, Role.HOUSING})
_CHANGE = 1e-8
"""Of a state, in SI units; the parts are linear."""


class Linear(NamedTuple):
    """A system's parts under load, linear; a mesh may be open where the run begins."""

    network: Network
    members: list[Member]
    open: bool


def linear(system: System) -> Linear | None:
    """The parts as they start, or each gearbox by itself; None where neither can be had."""
    with_load = not system.foreign_parts
    try:
        if with_load:
            return Linear(*linear_network(system), open=False)
    except ParameterError:  # a mesh is open
        pass
    except HerringboneError:
        return None
    boxes = _only(system, _BOX)
    if not boxes.parts:
        return None
    try:
        alone = loaded(boxes)
        return Linear(*linear_network(alone.with_values(loaded_start(alone)[0])), open=with_load)
    except HerringboneError:
        return None


def _only(system: System, roles: Iterable[Role]) -> System:
    """The system's own parts of some roles, and what joins them."""
    known, wanted = anatomy(system), set(roles)
    parts = tuple(
        part
        for part in system.parts
        if not part.foreign and wanted & set(known.parts[part.name].roles)
    )
    names = {part.name for part in parts}
    connections = tuple(
        pair for pair in system.connections if {system.split(path)[0] for path in pair} <= names
    )
    return replace(system, parts=parts, connections=connections)


def stable_step(part: Instance) -> float:
    """The longest stable inner step of a linear part by itself [s]."""
    count = part.component.declaration.state_count
    block = part.block.copy()
    before, after = np.empty(count), np.empty(count)
    part.component.kernels.rhs(block, 0.0, before)
    matrix = np.empty((count, count))
    for k in range(count):
        value = block[k]
        block[k] = value + _CHANGE
        part.component.kernels.rhs(block, 0.0, after)
        matrix[:, k] = (after - before) / (block[k] - value)
        block[k] = value
    highest = float(np.abs(np.linalg.eigvals(matrix)).max(initial=0.0))
    return STABLE / highest if highest > 0.0 else np.inf

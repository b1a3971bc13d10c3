"""Pairs of force and velocity between elements and bodies, and how the forces depend on the motion.

A force that an element sends to a body, and the velocity that the same body sends to the same port
of the element, make a pair whose product is a power. What the elements' dampers take follows from
the forces' dependence on the velocities, and the forces at a motion that an element has not seen
from that on the positions too; both are measured in initialisation mode, where outputs follow
inputs.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from herringbone.cosim.structure.connection import Connection
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.rates import motion_of_force

_VELOCITY_CHANGE = 1e-3
"""Difference of a velocity [m/s or rad/s]."""
_POSITION_CHANGE = 1e-8
"""Difference of a position [m or rad]."""
_NOTHING = 1e-9
_CYCLE = 4.0 * math.pi
"""Of a four-stroke engine, whose torque has half orders, too [rad]."""
_SAME = 1e-6
"""Change of a torque by such a cycle, over that by its slope and a radian, that counts as none."""


@dataclass(frozen=True)
class PowerPair:
    """A force on a body and the body's motion there.

    Attributes:
        force: connection from the element to the body.
        velocity: connection from the body to the element.
        position: likewise; None if the element takes no position.
    """

    force: Connection
    velocity: Connection
    position: Connection | None


def power_pairs(network: Network) -> tuple[PowerPair, ...]:
    """All pairs of force and velocity between elements and bodies, by their names."""
    bodies = {*network.bodies, *network.slow}
    by_input = {(c.target, c.input): c for c in network.connections}
    found = []
    for c in network.connections:
        motion = motion_of_force(c.output)
        if motion is None or c.source not in network.elements or c.target not in bodies:
            continue
        position, velocity = (by_input.get((c.source, name)) for name in motion)
        if velocity is None or velocity.source != c.target:
            continue
        same = position is not None and position.source == c.target
        found.append(PowerPair(c, velocity, position if same else None))
    return tuple(found)


def _sensitivity(
    network: Network, pairs: Sequence[PowerPair], moved: Sequence[Connection | None], change: float
) -> np.ndarray:
    """-d force / d motion, (pairs, pairs), by differences; in initialisation mode only.

    Args:
        network: parts and connections.
        pairs: whose forces are looked at.
        moved: a motion of each pair that an element takes; None for none.
        change: of the motion.
    """
    found = np.zeros((len(pairs), len(pairs)))
    for j, c in enumerate(moved):
        if c is None:
            continue
        element = network.parts[c.target]
        rows = [i for i, pair in enumerate(pairs) if pair.force.source == c.target]
        forces = [pairs[i].force.output for i in rows]
        start = element.get([c.input])[0]
        values = []
        for moved_by in (change, -change):
            element.set(c.input, start + moved_by)
            values.append(np.array(element.get(forces)))
        element.set(c.input, start)
        slope = -(values[0] - values[1]) / (2.0 * change)
        found[rows, j] = np.where(np.abs(slope) > _NOTHING * np.abs(slope).max(), slope, 0.0)
    return found


def damping_of(network: Network, pairs: Sequence[PowerPair]) -> np.ndarray:
    """-d force / d velocity, (pairs, pairs); in initialisation mode only."""
    return _sensitivity(network, pairs, [p.velocity for p in pairs], _VELOCITY_CHANGE)


def stiffness_of(network: Network, pairs: Sequence[PowerPair]) -> np.ndarray:
    """-d force / d position of springs, (pairs, pairs); in initialisation mode only.

    A torque against the ground that is the same after two turns, as that of an engine's orders, is
    no spring.
    """
    found = _sensitivity(network, pairs, [p.position for p in pairs], _POSITION_CHANGE)
    sources = [pair.force.source for pair in pairs]
    for i, pair in enumerate(pairs):
        alone = sources.count(sources[i]) == 1
        if alone and found[i, i] != 0.0 and _is_periodic(network, pair, abs(found[i, i])):
            found[i, i] = 0.0
    return found


def _is_periodic(network: Network, pair: PowerPair, slope: float) -> bool:
    """True if the torque is the same after two whole turns."""
    position = pair.position
    if position is None or not pair.force.output.rpartition(".")[2].startswith("tau"):
        return False
    element = network.parts[pair.force.source]
    start = element.get([position.input])[0]
    before = element.get([pair.force.output])[0]
    element.set(position.input, start + _CYCLE)
    after = element.get([pair.force.output])[0]
    element.set(position.input, start)
    return bool(abs(after - before) < _SAME * slope)

"""Shafts that a coupling joins and that turn unlike when a run starts: a blow that nobody meant."""

from collections.abc import Iterator

from herringbone.core.part import Part
from herringbone.cosim.structure.connection import Connection
from herringbone.cosim.structure.network import Network

_SPEED, _TORQUE = "rad/s", "N.m"
_UNLIKE = 0.05
"""Of the faster shaft: a smaller difference is one of twist that settles."""
_SLOW = 1.0
"""Speeds below are rest [rad/s]."""
_OPPOSITE = 1e-6


def unlike_speeds(network: Network) -> Iterator[str]:
    """A line for each part without states that joins two shafts of unlike speed.

    One whose torques on both are not opposite is a gear, whose shafts need not turn alike.

    Args:
        network: its parts are initialised.
    """
    for target in network.elements:
        joined = [c for c in network.inputs(target) if _unit(network.parts[target], c) == _SPEED]
        if len(joined) != 2:
            continue
        first, second = (network.parts[c.source].get([c.output])[0] for c in joined)
        faster = max(abs(first), abs(second))
        if faster < _SLOW or abs(first - second) < _UNLIKE * faster:
            continue
        torque = _torque(network, target)
        if torque > 0.0:
            shafts = " and ".join(
                f"{network.parts[c.source].name}.{c.output} = {speed:.5g} {_SPEED}"
                for c, speed in zip(joined, (first, second), strict=True)
            )
            yield (
                f"{network.parts[target].name} joins {shafts} at the start, by {torque:.4g} "
                f"{_TORQUE} at once; set start values that turn alike, or begin at rest on both "
                "sides"
            )


def _unit(part: Part, c: Connection) -> str | None:
    return part.variables[c.input].unit


def _torque(network: Network, number: int) -> float:
    """Torque of a part on both of its shafts [N m]; 0 if they are not opposite."""
    part = network.parts[number]
    given = dict.fromkeys(c.output for c in network.connections if c.source == number)
    torques = part.get([name for name in given if part.variables[name].unit == _TORQUE])
    if len(torques) != 2 or abs(sum(torques)) > _OPPOSITE * abs(torques[0]):
        return 0.0
    return abs(torques[0])

"""Shafts that a coupling joins and that turn unlike when a run starts: a blow that nobody meant."""

import math
from collections.abc import Iterator

from herringbone.core.part import Part
from herringbone.core.wording import setting
from herringbone.cosim.signature import Kind
from herringbone.cosim.starting.approached_part import approached_of
from herringbone.cosim.structure.connection import Connection
from herringbone.cosim.structure.network import Network

_SPEED, _TORQUE = "rad/s", "N.m"
_ROTATION = {_SPEED, None, ""}
"""Units of an input that may be a speed: foreign parts declare none, or this."""
_UNLIKE = 0.05
"""Of the faster shaft: a smaller difference is one of twist that settles."""
_SLOW = 1.0
"""Speeds below are rest [rad/s]."""
_OPPOSITE = 1e-6
_SHOWN = 3
"""Variables that a line names."""


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
        if not _unlike(first, second):
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


def unlike_inside(network: Network) -> Iterator[str]:
    """A line for each part whose own shaft joins a turning one to what turns unlike behind it.

    Args:
        network: its parts are initialised; those with a signature were tried at their start. A play
            that is open there is none of its elements, and has no shaft behind it.
    """
    for target in network.bodies:
        part = network.parts[target]
        signature = getattr(part, "signature", None)
        if signature is None or signature.kind is Kind.ELEMENT or approached_of(part):
            continue
        fed = {c.input: c for c in network.inputs(target)}
        for number, inside in enumerate(signature.speeds):
            name = signature.inputs[signature.rate_inputs[number]]
            if math.isnan(inside) or name not in fed or _unit(part, fed[name]) not in _ROTATION:
                continue
            source = network.parts[fed[name].source]
            (outside,) = source.get([fed[name].output])
            if _unlike(inside, outside):
                yield (
                    f"{part.name}: what is behind its shaft at {signature.inputs[number]} turns at "
                    f"{_round(inside)} {_SPEED} at the start, and meets {source.name}."
                    f"{fed[name].output} = {outside:.5g} {_SPEED}, a jump; set the start value of "
                    f"its speed ({_to_set(part, f'{outside:.5g}')}), or that of what it meets "
                    f"({_to_set(source, _round(inside))})"
                )


def _to_set(part: Part, speed: str) -> str:
    """How a part is told its speed [rad/s]: by what may be set in that unit at its start."""
    known = [v for v in part.variables.values() if v.causality == "parameter" or v.starts]
    named = [v.name for v in known if v.unit == _SPEED]
    if named:
        return " or ".join(setting(f"{part.name}.{name}", speed) for name in named[:_SHOWN])
    return f"{speed} {_SPEED}, by a start value of {part.name}: it declares none in {_SPEED}"


def _round(speed: float) -> str:
    """A speed that trials tell to a share of what counts as alike."""
    return f"{speed:.3g}" if abs(speed) >= _SLOW else "0"


def _unlike(first: float, second: float) -> bool:
    faster = max(abs(first), abs(second))
    return faster >= _SLOW and abs(first - second) >= _UNLIKE * faster


def _unit(part: Part, c: Connection) -> str | None:
    return part.variables[c.input].unit


def _torque(network: Network, number: int) -> float:
    """Torque of a part on both of its shafts [N m]; 0 if they are not opposite."""
    part = network.parts[number]
    torques = part.get(
        [name for name in network.outputs(number) if part.variables[name].unit == _TORQUE]
    )
    if len(torques) != 2 or abs(sum(torques)) > _OPPOSITE * abs(torques[0]):
        return 0.0
    return abs(torques[0])

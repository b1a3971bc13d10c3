"""Angles that a foreign part wraps at a full turn.

An angle that jumps by 2 pi while its speed says nothing of it twists what hangs on it by a turn.
"""

import math
from collections.abc import Collection, Sequence

import numpy as np

from herringbone.core.part import PartVariable
from herringbone.cosim.structure.rates import named_rate

_ANGLE = (("rad", 1),)
_TURN = 2.0 * math.pi
_NEAR = 0.1
"""Of a turn: by how much a jump may miss it, and how far the angle may otherwise be off."""
_FEWEST = 3
_NAMED = "phi"


def wrapped_angles(
    names: Sequence[str],
    variables: Sequence[PartVariable],
    taken: Collection[str],
    times: np.ndarray,
    values: np.ndarray,
) -> list[str]:
    """A line for each recorded angle of a foreign part that jumps by a turn.

    Args:
        names: `instance.variable` (m).
        variables: of them (m).
        taken: names of those that are connected.
        times: of the records (n,) [s].
        values: recorded, in the variables' own units (n, m).
    """

    def in_si(k: int) -> np.ndarray:
        v = variables[k]
        factor, offset = v.own_unit[1:] if v.own_unit else (v.dimension or (1.0, 0.0))[:2]
        return factor * values[:, k] + offset

    place = {name: k for k, name in enumerate(names)}
    found = []
    for k, (name, v) in enumerate(zip(names, variables, strict=True)):
        rate = named_rate(name, place)
        if v.rate is not None or not _is_angle(name, v, rate) or times.size < _FEWEST:
            continue
        speed = None if rate is None else in_si(place[rate])
        if jumps := _jumps(times, in_si(k), speed):
            more = f" and at {len(jumps) - 1} more times" if len(jumps) > 1 else ""
            twist = ", and what is connected to it is twisted by 2 pi; let it count on"
            found.append(
                f"{name} jumps by a turn at {times[jumps[0]]:.6g} s{more}: the part wraps its angle"
                + (twist if name in taken else "; nothing is connected to it")
            )
    return found


def _is_angle(name: str, v: PartVariable, rate: str | None) -> bool:
    """True for what is measured in radians; without a unit, for a `phi` whose speed is there."""
    if v.dimension is not None:
        return tuple(v.dimension[2]) == _ANGLE
    named = name.rpartition(".")[2].partition("_")[0] == _NAMED
    return v.unit == "rad" or (not v.unit and named and rate is not None)


def _jumps(times: np.ndarray, angle: np.ndarray, speed: np.ndarray | None) -> list[int]:
    """Rows before which the angle moves by a turn more or less than its speed says.

    Without speed: than before and after.
    """
    moved = np.diff(angle)
    if speed is None:
        before, after = np.roll(moved, 1), np.roll(moved, -1)
        before[0], after[-1] = moved[1], moved[-2]
        moved = moved - 0.5 * (before + after)
        quiet = np.abs(after - before) < _NEAR * _TURN
    else:
        moved = moved - 0.5 * (speed[1:] + speed[:-1]) * np.diff(times)
        quiet = np.abs(np.diff(speed)) * np.diff(times) < _NEAR * _TURN
    turns = np.abs(np.abs(moved) / _TURN - 1.0) < _NEAR
    return [int(i) + 1 for i in np.flatnonzero(turns & quiet)]

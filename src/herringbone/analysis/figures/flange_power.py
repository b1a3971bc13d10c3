"""Powers through the flanges of a drivetrain, from what a run recorded.

Where a flange that gives torque is joined to one that gives speed, the power tau w goes into the
part that turns and out of the one that gives the torque. A part takes what comes in by all its
flanges: a source takes a negative power, a gearbox what it loses, a mass what it stores. All of
them together take nothing, so that

    given by sources = taken by loads + lost + change of the stored energy.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from herringbone.analysis.figures.operating_point import steady_part
from herringbone.result.result import Result

_VISIBLE = 1e-6


class FlangePowers(NamedTuple):
    """Powers at every record.

    Attributes:
        taken: what each part takes through its flanges (n,) [W], by the part's name.
        passing: largest mean power that passes a flange, whatever its direction [W].
    """

    taken: Mapping[str, np.ndarray]
    passing: float


def flange_powers(result: Result) -> FlangePowers:
    """Powers that parts take; those of which a torque or a speed is not recorded are left out."""
    found: dict[str, np.ndarray] = {}
    unknown: set[str] = set()
    passing, rows = 0.0, steady_part(result).rows
    for one, other in result.info.anatomy.joints:
        power = _power(result, one, other)
        if power is None:
            unknown |= {one[0], other[0]} if _is_flange(result, one) else set()
            continue
        passing = max(passing, abs(float(power[rows].mean())))
        for part, sign in ((one[0], -1.0), (other[0], 1.0)):
            found[part] = found.get(part, 0.0) + sign * power
    return FlangePowers({p: power for p, power in found.items() if p not in unknown}, passing)


class MeanPowers(NamedTuple):
    """Means over the steady part of a run [W]: see `FlangePowers`."""

    taken: Mapping[str, float]
    passing: float

    @property
    def visible(self) -> list[tuple[str, float]]:
        """Parts that give or take more than a millionth of what passes; givers first."""
        least = _VISIBLE * self.passing
        found = ((part, power) for part, power in self.taken.items() if abs(power) > least)
        return sorted(found, key=lambda item: item[1])


def mean_powers(result: Result) -> MeanPowers | None:
    """Mean powers over the steady part of a run; None where no flanges are joined."""
    powers, rows = flange_powers(result), steady_part(result).rows
    if not powers.taken:
        return None
    taken = {part: float(power[rows].mean()) for part, power in powers.taken.items()}
    return MeanPowers(taken, powers.passing)


def _power(result: Result, one: tuple[str, str], other: tuple[str, str]) -> np.ndarray | None:
    """Power out of `one` and into `other`; None if nothing tells it."""
    for (torque, speed), sign in (((one, other), 1.0), ((other, one), -1.0)):
        columns = f"{'.'.join(torque)}.tau", f"{'.'.join(speed)}.w"
        if all(column in result.data for column in columns):
            tau, w = (result.data[column].to_numpy() for column in columns)
            return sign * tau * w
    return None


def _is_flange(result: Result, end: tuple[str, str]) -> bool:
    return any(f"{'.'.join(end)}.{q}" in result.data for q in ("tau", "w"))

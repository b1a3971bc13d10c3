"""The points of a study, and the chains of neighbours that they make."""

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random

from herringbone.analysis.set_points import SPEED, TORQUE
from herringbone.core import ParameterError
from herringbone.core.given import is_number, no_number
from herringbone.core.wording import several_values

SET_POINTS = {SPEED: "rad/s", TORQUE: "N.m"}
"""Parameters that address what a system declares as its set points, and their SI units."""
PER_MINUTE = "r/min"
_OTHERS = str | Path | bool
"""What foreign FMUs take besides numbers."""

Value = float | str
Point = dict[str, Value]
"""Values by parameter: `speed`, `torque`, or `instance.variable`."""


@dataclass(frozen=True)
class Study:
    """Points in the order of their rows.

    Attributes:
        names: parameters.
        points: values (points, names) in SI units, but for the speed.
        speed_unit: "rad/s" or "r/min".
        line: so many points after each other are neighbours, from the first one on.
    """

    names: tuple[str, ...]
    points: tuple[tuple[Value, ...], ...]
    line: int = 1
    speed_unit: str = SET_POINTS[SPEED]

    def __post_init__(self) -> None:
        """Check it.

        Raises:
            ParameterError: it has no points, or one twice, or a value is no number or text.
        """
        if not self.points:
            raise ParameterError("a study takes at least one point")
        units = {**SET_POINTS, SPEED: self.speed_unit}
        for name, values in zip(self.names, zip(*self.points, strict=True), strict=True):
            for value in values:
                if not is_number(value) and (name in units or not isinstance(value, _OTHERS)):
                    raise no_number(name, value, units.get(name, ""))
        if len(set(self.points)) < len(self.points):
            twice = next(p for p in self.points if self.points.count(p) > 1)
            told = ", ".join(f"{n} = {v}" for n, v in zip(self.names, twice, strict=True))
            raise ParameterError(f"the point {told} stands twice in the study; drop one")

    def point(self, number: int) -> Point:
        """Values of a point, in SI units."""
        point = dict(zip(self.names, self.points[number], strict=True))
        if SPEED in point and self.speed_unit == PER_MINUTE:
            point[SPEED] = float(point[SPEED]) * math.pi / 30.0
        return point

    def chains(self, longest: int | None) -> list[range]:
        """Numbers of the points of each chain: neighbours, at most so many; None: all of a line."""
        length = self.line if longest is None else min(longest, self.line)
        return [
            range(first, min(first + length, start + self.line, len(self.points)))
            for start in range(0, len(self.points), self.line)
            for first in range(start, min(start + self.line, len(self.points)), length)
        ]


def grid(axes: Mapping[str, Sequence[Value]]) -> Study:
    """All combinations of values; neighbours differ in speed, or in the last parameter.

    Args:
        axes: values by parameter, in the order in which rows go through them, the first slowest.

    Raises:
        ParameterError: an axis is empty, or a value stands twice.
    """
    if not axes:
        raise ParameterError(
            f"a study takes at least one parameter, such as {several_values('speed')}"
        )
    if empty := [name for name, values in axes.items() if not len(values)]:
        raise ParameterError(f"{empty[0]}: it has no values")
    fast = SPEED if SPEED in axes else list(axes)[-1]
    names = (*(name for name in axes if name != fast), fast)
    return Study(names, tuple(itertools.product(*(axes[name] for name in names))), len(axes[fast]))


def listed(points: Sequence[Mapping[str, Value]]) -> Study:
    """Points one by one, none of which is a neighbour of another.

    Raises:
        ParameterError: they have not the same parameters.
    """
    names = tuple(points[0]) if points else ()
    for number, point in enumerate(points, 1):
        if set(point) != set(names):
            raise ParameterError(
                f"point {number} has the parameters {', '.join(point)}, and the first one has "
                f"{', '.join(names)}; give all points the same ones"
            )
    return Study(names, tuple(tuple(point[name] for name in names) for point in points))


def sampled(between: Mapping[str, tuple[float, float]], count: int, seed: int) -> Study:
    """Points at random, of which each parameter has one in each of `count` equal intervals.

    M. D. McKay, R. J. Beckman, W. J. Conover, Technometrics 21, 1979, 239-245 (Latin hypercube).

    Args:
        between: lowest and highest value by parameter.
        count: number of points.
        seed: of the random numbers; the same seed gives the same points.
    """
    draw = Random(seed).random  # whose numbers Python promises to keep
    columns = []
    for low, high in between.values():
        order = sorted((draw(), k) for k in range(count))
        columns.append([low + (k + draw()) / count * (high - low) for _, k in order])
    return Study(tuple(between), tuple(zip(*columns, strict=True)))

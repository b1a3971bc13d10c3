"""Operating points of a range: some to probe at, others to test at."""

from collections.abc import Iterator
from itertools import product

import numpy as np

from herringbone.analysis.steady.operating_point import Point
from herringbone.core import ParameterError
from herringbone.scenes.asking import Operating, Range

TESTS, _FEW = 12, 6
"""Points of a range that are tested at; where the period has many meshes."""
_PROBES = {"speed": (0.0, 0.5, 1.0), "torque": (0.0, 1.0)}
_SPREAD = 0.754877666, 0.569840291
"""Steps of a sequence that fills a square evenly (M. Roberts, 2018): powers of the inverse of the
plastic number."""


def first_point(operating: Operating) -> Point:
    """The lowest of the ranges."""
    return points_to_probe(operating)[0]


def points_to_probe(operating: Operating) -> list[Point]:
    """Ends and middle of the ranges; the scene's own point without any.

    Raises:
        ParameterError: torques of both signs, or none.
    """
    if operating.torque is not None and operating.torque[0] <= 0.0 <= operating.torque[1]:
        low, high = operating.torque
        raise ParameterError(
            f"torque = [{low:g}, {high:g}]: no load holds the teeth at 0 N m, and beyond it the "
            "other flank carries, with another line of action; ask for one sign at a time"
        )
    ends = {"speed": operating.speed, "torque": operating.torque}
    values = {key: _at(given, _PROBES[key]) for key, given in ends.items()}
    return [Point(speed, torque) for torque, speed in product(values["torque"], values["speed"])]


def points_to_test(operating: Operating, *, long: bool = False) -> list[Point]:
    """Points that fill the ranges, by ascending speed; none of them is probed at.

    Args:
        operating: the ranges.
        long: the period has many meshes.

    Without a range, the scene's own point, where nothing else is asked.
    """
    if all(given is None or given[0] == given[1] for given in (operating.speed, operating.torque)):
        return points_to_probe(operating)[:1]
    shares = np.mod(0.5 + np.outer(np.arange(1, (_FEW if long else TESTS) + 1), _SPREAD), 1.0)
    return sorted(_spread(operating, shares), key=lambda point: abs(point.speed or 0.0))


def _spread(operating: Operating, shares: np.ndarray) -> Iterator[Point]:
    for own in shares:
        speed, torque = (
            _at(given, (float(share),))[0]
            for given, share in zip((operating.speed, operating.torque), own, strict=True)
        )
        yield Point(speed, torque)


def _at(given: Range | None, shares: tuple[float, ...]) -> list[float | None]:
    if given is None:
        return [None]
    low, high = given
    return list(dict.fromkeys(low + share * (high - low) for share in shares))

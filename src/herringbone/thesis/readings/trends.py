"""How trends of figures become margins: positive where a trend is there, by how much."""

from collections.abc import Callable, Sequence
from itertools import pairwise

from herringbone.thesis.readings.measures import LEVEL, series
from herringbone.thesis.readings.points import (
    DEVIATIONS,
    MEASURED_SPEEDS,
    SPEED,
    SPEEDS,
    TORQUE,
    At,
    Figures,
)

SEEN = 0.05
"""What a printed figure shows."""
NOTICEABLE, LITTLE = 0.25, 0.25
"""A sensor's position matters noticeably, and does not matter: at least, and at most."""
KINDS = "s", "v"
"""Displacement and velocity."""

Margin = Callable[[Figures, float], float]
"""Of figures, and the symmetry deviation at which torque and speed are varied."""


def over_deviations(whats: Sequence[str]) -> Margin:
    """Levels grow over the symmetry deviation."""

    def margin(figure: Figures, deviation: float) -> float:
        del deviation
        return min(
            series([figure(what, LEVEL, At(d, TORQUE, SPEED)) for d in DEVIATIONS])
            for what in whats
        )

    return margin


def over_torques(whats: Sequence[str], kind: str, torques: Sequence[float]) -> Margin:
    """Figures of a kind grow over the torque."""

    def margin(figure: Figures, deviation: float) -> float:
        return min(
            series([figure(what, kind, At(deviation, t, SPEED)) for t in torques]) for what in whats
        )

    return margin


def over_speeds(whats: Sequence[str], kind: str, speeds: Sequence[float]) -> Margin:
    """Figures of a kind grow over the speed."""

    def margin(figure: Figures, deviation: float) -> float:
        return min(
            series([figure(what, kind, At(deviation, TORQUE, n)) for n in speeds]) for what in whats
        )

    return margin


def larger(pairs: Sequence[tuple[str, str]], share: float = 1.0) -> Margin:
    """The first level of each pair exceeds a share of the second one, at both deviations."""

    def margin(figure: Figures, deviation: float) -> float:
        del deviation
        ats = [At(d, TORQUE, SPEED) for d in DEVIATIONS if d > 0.0]
        ratios = [
            figure(one, LEVEL, at) / max(share * figure(other, LEVEL, at), 1e-300)
            for one, other in pairs
            for at in ats
        ]
        return min(ratios) - 1.0

    return margin


def positions_alike(figure: Figures, deviation: float) -> float:
    """How much less than `LITTLE` the sensors differ at the lower speeds, over it."""
    spread = 0.0
    for speed in MEASURED_SPEEDS[:-1]:
        levels = [figure(s, LEVEL, At(deviation, TORQUE, speed)) for s in "ABC"]
        spread = max(spread, max(levels) / min(levels) - 1.0)
    return 1.0 - spread / LITTLE


def positions_grow(figure: Figures, deviation: float) -> float:
    """Least growth from A over B to C at the highest speed, and from A to C noticeably."""
    at = At(deviation, TORQUE, MEASURED_SPEEDS[-1])
    levels = [figure(s, LEVEL, at) for s in "ABC"]
    return min(series(levels), levels[-1] / levels[0] - 1.0 - NOTICEABLE + SEEN)


def amplified_when_fast(figure: Figures, deviation: float) -> float:
    """Growth by the deviation at the highest speed over that at the lowest one."""
    slow, fast = (
        min(
            figure(s, LEVEL, At(deviation, TORQUE, n)) / figure(s, LEVEL, At(0.0, TORQUE, n))
            for s in "ABC"
        )
        for n in (SPEEDS[0], SPEEDS[-1])
    )
    return fast / slow - 1.0


def _stiffness(figure: Figures, deviation: float) -> list[float]:
    at = At(deviation, TORQUE, SPEED)
    return [figure(f"{side}.stiffness", "mean", at) for side in ("left", "right")]


def stiffness_falls(figure: Figures, deviation: float) -> float:
    """Least fall of the sum of both sides, per step of the deviation."""
    del deviation
    total = [sum(_stiffness(figure, d)) for d in DEVIATIONS]
    return min(1.0 - b / a for a, b in pairwise(total))


def sides_differ(figure: Figures, deviation: float) -> float:
    """Growth of the loaded side's stiffness over the other's, per step of the deviation."""
    del deviation
    ratios = []
    for d in DEVIATIONS:
        stiffness = _stiffness(figure, d)
        loads = [figure(f"{s}.load", "mean", At(d, TORQUE, SPEED)) for s in ("left", "right")]
        more = loads.index(max(loads))
        ratios.append(stiffness[more] / max(stiffness[1 - more], 1e-300))
    return min(b - a for a, b in pairwise(ratios))


def both(quantity: str, gears: Sequence[str]) -> list[str]:
    """Displacement and velocity of gears in a direction."""
    return [f"{gear}.{kind}_{quantity}" for gear in gears for kind in KINDS]

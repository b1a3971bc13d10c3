"""Figures of a motion on which the thesis' sentences are judged."""

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from herringbone.thesis.names import BEARINGS, GEAR
from herringbone.thesis.readings.motion import Motion

WINDOW = 0.02
"""Length of what the thesis evaluates [s]."""
SETTLED, AS_PUBLISHED = "settled", "window of 20 ms"
"""Evaluations: over whole periods, and over 20 ms, averaged over where they begin."""
EVALUATIONS = SETTLED, AS_PUBLISHED
LEVEL, SWING = "level", "swing"
"""Root mean square of the alternating part, and half of what it goes up and down."""
GEARS = "pinion", "wheel"
_SIDES = "left", "right"


def measures(motion: Motion) -> dict[tuple[str, str, str], float]:
    """Figures by what, kind and evaluation, SI units.

    What: `pinion.v_z` and its like of the gears (both halves, root mean square), `pinion.f_y` of
    the bearings, `pinion.seat_radial` and `pinion.seat_axial` of the housing's velocity, sensors
    `A`, `B`, `C`; and, with the kind "mean", secant stiffness `left.stiffness`, `right.stiffness`.
    """
    found: dict[tuple[str, str, str], float] = {}
    groups, places = _groups(motion), _places(motion)
    signals = np.array([signal for own in groups.values() for signal in own])
    ends = np.cumsum([len(own) for own in groups.values()])
    settled = _squares_and_swings(signals[:, None, :])
    published = settled if places is None else _squares_and_swings(signals[:, places])
    for evaluation, (squares, swings) in zip(EVALUATIONS, (settled, published), strict=True):
        for (what, own), end in zip(groups.items(), ends, strict=True):
            here = slice(end - len(own), end)
            square = squares[here].sum() / _directions(what, len(own))
            found[what, LEVEL, evaluation] = math.sqrt(square)
            found[what, SWING, evaluation] = math.sqrt(np.mean(swings[here] ** 2))
    for side in _SIDES:
        force, deflection = (
            motion.signals[f"{GEAR}.mesh_{side}.{q}"] for q in ("force", "deflection")
        )
        touching = deflection.mean() > 0.0
        stiffness = float(force.mean() / deflection.mean()) if touching else 0.0
        found[f"{side}.stiffness", "mean", SETTLED] = stiffness
        found[f"{side}.load", "mean", SETTLED] = float(force.mean())
    return found


def _groups(motion: Motion) -> dict[str, list[np.ndarray]]:
    """Signals (n,) by what they tell."""
    s = motion.signals
    found: dict[str, list[np.ndarray]] = {}
    for gear in GEARS:
        halves = [f"{gear}_{side}" for side in _SIDES]
        for kind in ("s_y", "v_y", "s_z", "v_z"):
            found[f"{gear}.{kind}"] = [s[f"{GEAR}.{h}.{kind}"] for h in halves]
        for axis in "yz":
            found[f"{gear}.f_{axis}"] = [s[f"{BEARINGS}.shaft.{h}.f_{axis}"] for h in halves]
        found[f"{gear}.seat_radial"] = [s[h, axis] for h in halves for axis in "xy"]
        found[f"{gear}.seat_axial"] = [s[h, "z"] for h in halves]
    for sensor in ("A", "B", "C"):
        found[sensor] = [s[sensor, "z"]]
    return found


def _directions(what: str, signals: int) -> int:
    """By what squares are divided: both directions of a radial motion add up."""
    return signals // 2 if what.endswith("seat_radial") else signals


def _squares_and_swings(pieces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean squares and swings (signals,) of the alternating part of each piece, over the pieces.

    Args:
        pieces: signals (signals, pieces, n), cut into what is evaluated at once.
    """
    off = pieces - pieces.mean(axis=-1, keepdims=True)
    squares = np.einsum("spn,spn->s", off, off) / off[0].size
    return squares, 0.5 * np.ptp(off, axis=-1).mean(axis=-1)


def _places(motion: Motion) -> np.ndarray | None:
    """Samples (pieces, n) of the windows; None where a window is the whole motion."""
    count = len(next(iter(motion.signals.values())))
    length = round(WINDOW / motion.step)
    if motion.repeats or length >= count:
        return None
    pieces = math.ceil(count / length)
    starts = np.arange(pieces) * count // pieces
    return (starts[:, None] + np.arange(length)) % count


def series(values: Sequence[float]) -> float:
    """By how much the least step of a series grows, over what it grows from."""
    steps = [b / a - 1.0 if a > 0.0 else math.inf for a, b in pairwise(values)]
    return min(steps)

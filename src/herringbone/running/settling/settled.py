"""What a foreign part has come to in a trial, and whether it will settle at all."""

import math
from typing import NamedTuple

import numpy as np

LONGEST = 5.12
"""Time that a part may take to settle [s]; of its own time, so that every machine starts alike."""
CHANGES = 5e-4
"""Of the largest value of its unit that counts as settled: over the last quarter; or of its curve
there about a straight line, and of its end if it is given half the time."""
_EVENLY, _TWICE = 0.05, 2.0
"""What drifts keeps its rate by so much; factor by which a time to settle may be told wrong."""
_TELLING, _SURELY = 0.16, 1.28
"""Shortest trial that tells of later times [s]; that tells what does not die out at all."""
_EVER = 100.0
_TURNS = 1.0
"""Turns in a quarter from which on what still changes is known not to pulsate with them; slower
shafts do not come to that."""
_ALIKE = 0.8
"""Ratio of rates of decay that two trials tell of what dies out evenly: quarters shorter than a
period of an oscillation tell different ones."""
_LATER = 8.0 / 3.0
"""Time of a trial over that from the end of its rise to the middle of its last quarter."""


class Settled(NamedTuple):
    """What a part has come to.

    Attributes:
        outputs: (m,) at the start of the run.
        change: over the last quarter, over the largest value of its unit, of the worst output.
        bend: the same about straight lines.
        worst: name of that output.
        peak: (m,) largest values.
        moved: change of that output [its unit].
        before: `change` of that output over the quarter before.
        turns: of the slowest shaft in the last quarter; infinite if none turns.
        pulsation: name of the output that pulsates most as shafts turn, and half of its range [its
            unit]; then all the others are of means over a period.
    """

    outputs: np.ndarray
    change: float
    bend: float
    worst: str
    peak: np.ndarray
    moved: float
    before: float
    turns: float = math.inf
    pulsation: tuple[str, float] = ("", 0.0)


def why_not(found: Settled, before: Settled, duration: float, unit: str) -> str:
    """Why an output will not settle in time, as far as two trials tell; "" if they do not.

    What drifts at the same rate in both is the integral of what it is given, or as good as that.
    Of what dies out evenly, two quarters of each trial tell in which time it does.

    Args:
        found: after this time, not settled.
        before: after half of it, not settled either.
        duration: see above [s].
        unit: of the worst output.
    """
    if before.worst != found.worst or duration < _TELLING:
        return ""
    straight = max(s.bend / s.change for s in (found, before)) < _EVENLY
    straight = straight and abs(found.before - found.change) < _EVENLY * found.change
    if straight and abs(2.0 * before.moved - found.moved) < _EVENLY * found.moved:
        rate = 4.0 * found.moved / duration
        return f"goes on evenly, by {rate:.3g} {unit} a second, in the steady motion: it integrates"
    times = _time_to_settle(before, 0.5 * duration), _time_to_settle(found, duration)
    may_pulsate = found.turns < _TURNS <= found.turns * LONGEST / duration
    if min(times) <= _TWICE * LONGEST or may_pulsate:
        return ""
    rates = _decay(before, 0.5 * duration), _decay(found, duration)
    if min(times) <= _EVER * LONGEST and min(rates) < _ALIKE * max(rates):
        return ""
    if times[1] > _EVER * LONGEST:
        return f"does not die out in {duration:.3g} s"
    return (
        f"dies out so slowly that it would take some {times[1]:.2g} s; {LONGEST:g} s are the most"
    )


def dies_out(found: Settled, before: Settled, duration: float) -> bool:
    """If what is left would change no more, as it dies out evenly in two trials.

    Args:
        found: after this time.
        before: after half of it.
        duration: see above [s].
    """
    slower, faster = sorted((_decay(before, 0.5 * duration), _decay(found, duration)))
    if before.worst != found.worst or slower <= 0.0 or slower < _ALIKE * faster:
        return False
    return found.change**2 <= CHANGES * found.before


def _time_to_settle(found: Settled, duration: float) -> float:
    """Time [s] of a trial in which it would settle, by how it dies out in this one; 0: not told."""
    if found.change >= found.before:
        return math.inf if duration >= _SURELY else 0.0
    return duration + _LATER * math.log(max(found.change / CHANGES, 1.0)) / _decay(found, duration)


def _decay(found: Settled, duration: float) -> float:
    """Rate [1/s] at which it dies out from one quarter to the next; 0: it does not."""
    if not 0.0 < found.change < found.before:
        return 0.0
    return math.log(found.before / found.change) / (0.25 * duration)

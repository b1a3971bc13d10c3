r"""The error of a run from runs with longer steps, and the power of the step with which it falls.

With steps h1 > h2 > h3 and an error C h^p, the results differ by

    d12 = C (h1^p - h2^p),   d23 = C (h2^p - h3^p),

which gives p, and the error of the last run, C h3^p = d23 h3^p / (h2^p - h3^p). Differences are
what the longer steps err, and p is the power between these: at the last step more can be left of
what falls with a lower one. So powers of long steps, high by chance, do not count as they are.
"""

import math
from typing import NamedTuple

LOWEST, HIGHEST = 0.01, 8.0
"""Powers that are looked for."""
_LEAST, _ROUGH, _MOST, _HIGHEST = 0.5, 1.0, 2.0, 4.0
"""Powers that count: least; most of two runs that are far apart; of near ones until two runs in
turn have shown more; then. Errors of contacts scatter with the step: one power can be chance."""
FAR = 0.3
"""Difference of two runs above which the longer step follows no power."""


class Left(NamedTuple):
    """What a run errs, by runs with longer steps.

    Attributes:
        error: of the run [1].
        power: with which the differences fall; 1 where there is one only.
        counted: power that counts for the error.
    """

    error: float
    power: float
    counted: float


def step_power(first: float, second: float, steps: tuple[float, ...]) -> float:
    """Power p, between 0 and 8; 0 where differences do not fall, as without bound.

    Args:
        first: difference d12.
        second: difference d23.
        steps: h1 > h2 > h3 [s].
    """
    from scipy.optimize import brentq  # noqa: PLC0415 (lazy)

    if not first > 0.0 or not 0.0 < second < math.inf:
        return HIGHEST if first > 0.0 and second == 0.0 else 0.0

    def excess(p: float) -> float:
        two, three = ((h / steps[0]) ** p for h in steps[1:])
        return (1.0 - two) / (two - three) - first / second

    if excess(LOWEST) > 0.0:
        return 0.0
    return HIGHEST if excess(HIGHEST) < 0.0 else float(brentq(excess, LOWEST, HIGHEST))


def left_of(longer: float, step: float, power: float) -> float:
    """Error of a run over its difference from one with a longer step.

    Args:
        longer, step: of both runs [s].
        power: with which the error falls.
    """
    return step**power / (longer**power - step**power)


def left(first: float | None, second: float, steps: tuple[float, ...], before: float = 0.0) -> Left:
    """Error of a run by its difference from the one before, and that one's from its predecessor.

    Args:
        first: difference of both runs before; None: there is one only, or it is not known.
        second: difference of the run from the one before.
        steps: of the runs [s], in their order: at least two.
        before: power that was measured with one run less; 0: none.
    """
    power = 1.0 if first is None else step_power(first, second, steps[-3:])
    most = _MOST if first is None or first >= FAR else min(max(before, _MOST), _HIGHEST)
    counted = min(max(power, _LEAST), _ROUGH if second > FAR else most)
    return Left(second * left_of(steps[-2], steps[-1], counted), power, counted)

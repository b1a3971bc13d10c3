"""The involute function and its inverse."""

import math
from typing import Final

STEEPEST: Final = 0.5 * math.pi - 1e-6
"""Largest angle of which the involute function is told apart from others [rad]."""


def involute(angle: float) -> float:
    """inv(alpha) = tan(alpha) - alpha [rad]."""
    return math.tan(angle) - angle


def involute_angle(value: float) -> float:
    """The angle [rad] whose involute function is `value`, from 0 to that of `STEEPEST`."""
    from scipy.optimize import brentq  # noqa: PLC0415 (lazy)

    if value == 0.0:
        return 0.0
    return brentq(lambda angle: involute(angle) - value, 0.0, STEEPEST, xtol=1e-15)

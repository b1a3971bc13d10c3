"""How fast teeth may mesh in this model."""

import math

from herringbone.core import ParameterError

_FASTEST = 1e6
"""Mesh frequency [Hz] beyond which no body of a tooth is left that could be elastic: in a period
sound in steel goes 5 mm."""
_R_MIN = 30.0 / math.pi


def check_speed(speed: float, teeth: float) -> None:
    """Refuse a speed at which teeth cannot mesh.

    Args:
        speed: [rad/s].
        teeth: how many of them mesh in a turn at that speed.

    Raises:
        ParameterError: it is too high.
    """
    most = 2.0 * math.pi * _FASTEST / teeth
    if abs(speed) > most:
        raise ParameterError(
            f"speed = {speed:g} rad/s ({speed * _R_MIN:g} r/min): at most {most:.4g} rad/s "
            f"({most * _R_MIN:.4g} r/min), where teeth mesh {_FASTEST:g} times a second and sound "
            "goes through a tooth but once; ask for a lower speed"
        )

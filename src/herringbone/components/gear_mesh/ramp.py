"""How errors, deviations and unbalance come in over the first turns of the pinion."""

import numpy as np

from herringbone.components.gear_mesh import layout as at
from herringbone.kernels.jit import kernel


@kernel
def start(b: np.ndarray) -> None:
    """Remember the angle that the ramp begins at."""
    b[at.RAMP_FROM] = b[at.ANGLE]


@kernel
def ramp(b: np.ndarray) -> tuple[float, float]:
    """Factor R of all deviations, and its slope over the pinion's angle [1/rad]."""
    if b[at.RAMP_TURNS] == 0.0:
        return 1.0, 0.0
    per_angle = 1.0 / (at.TWO_PI * b[at.RAMP_TURNS])
    turned = per_angle * (b[at.ANGLE] - b[at.RAMP_FROM])
    t = abs(turned)
    if t >= 1.0:
        return 1.0, 0.0
    slope = 30.0 * t * t * (1.0 - t) * (1.0 - t) * per_angle
    return t * t * t * (10.0 + t * (6.0 * t - 15.0)), slope if turned > 0.0 else -slope

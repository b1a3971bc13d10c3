"""How errors, deviations and unbalance come in over the first turns of the pinion."""

import numpy as np

from herringbone.components.gear_mesh import layout as at
from herringbone.kernels.compiling.jit import kernel


@kernel
def start(b: np.ndarray) -> None:
    """Remember the angle that the ramp begins at."""
    b[at.RAMP_FROM] = b[at.ANGLE] + 0.5 * b[at.TWIST_P]


@kernel
def ramp_speed(b: np.ndarray) -> float:
    """Rate of the angle that the ramp follows, the mean of the pinion's halves [rad/s]."""
    return b[at.ANGLE + at.RATE] + 0.5 * b[at.TWIST_P + at.RATE]


@kernel
def turn_ramp(b: np.ndarray, torque: float) -> None:
    """Add a torque [N m] on the angle that the ramp follows."""
    b[at.TORQUE] += 0.5 * torque
    b[at.TORQUE + 1] += 0.5 * torque


@kernel
def ramp(b: np.ndarray) -> tuple[float, float]:
    """Factor R of what deviates, and its slope over the mean angle of the pinion [1/rad]."""
    if b[at.RAMP_TURNS] == 0.0:
        return 1.0, 0.0
    per_angle = 1.0 / (at.TWO_PI * b[at.RAMP_TURNS])
    turned = per_angle * (b[at.ANGLE] + 0.5 * b[at.TWIST_P] - b[at.RAMP_FROM])
    t = abs(turned)
    if t >= 1.0:
        return 1.0, 0.0
    slope = 30.0 * t * t * (1.0 - t) * (1.0 - t) * per_angle
    return t * t * t * (10.0 + t * (6.0 * t - 15.0)), slope if turned > 0.0 else -slope

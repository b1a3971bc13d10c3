"""What excites a contact beside its stiffness: meshing impact, given transmission error."""

import math

import numpy as np

from herringbone.components.gear_mesh import layout as at
from herringbone.components.gear_mesh.ramp import ramp, ramp_speed, turn_ramp
from herringbone.components.resources import transmission_error
from herringbone.kernels.compiling.jit import kernel, rare
from herringbone.kernels.elementary import cosine


@kernel
def wheel(b: np.ndarray, order: int) -> float:
    """Angle [rad] (order 0) or speed [rad/s] (order 1) of the wheel's left half."""
    o = order * at.RATE
    return (b[at.RB[0]] * b[at.ANGLE + o] - b[at.APPROACH + o]) * b[at.PER_WHEEL_RB]


@rare
def impact(b: np.ndarray, f: float, phase: float) -> float:
    """Force [N] of the meshing impact at a phase of flanks (f: 1 drive, -1 coast)."""
    entered = phase if f * b[at.ANGLE + at.RATE] >= 0.0 else b[at.CONTACT_RATIO] - phase
    into = (entered - math.floor(entered)) / b[at.IMPACT_DURATION]
    return 0.5 * b[at.IMPACT] * (1.0 - cosine(at.TWO_PI * into)) if into < 1.0 else 0.0


@rare
def error(b: np.ndarray, side: int, flank: int) -> tuple[float, float, float, float, float]:
    """e [m] of a side's flank, its rate, its slopes over the angles of pinion and wheel half.

    The last one is the slope of the ramp, over the mean angle of the pinion's halves.
    """
    pinion, gear = b[at.ANGLE] + side * b[at.TWIST_P], wheel(b, 0) + side * b[at.TWIST_W]
    errors = transmission_error.group(at.ERRORS, side, flank)
    e, per_pinion, per_wheel = transmission_error.error(b, errors, pinion, gear)
    share, slope = ramp(b)
    per_angle = e * slope
    e, per_pinion, per_wheel = share * e, share * per_pinion, share * per_wheel
    rate = per_angle * ramp_speed(b) + per_pinion * (
        b[at.ANGLE + at.RATE] + side * b[at.TWIST_P + at.RATE]
    )
    rate += per_wheel * (wheel(b, 1) + side * b[at.TWIST_W + at.RATE])
    return e, rate, per_pinion, per_wheel, per_angle


@rare
def turn_errors(b: np.ndarray, side: int, flank: int, pressure: float) -> None:
    """Add the torques on what moves the error under a pressure [N]."""
    _, _, per_pinion, per_wheel, per_angle = error(b, side, flank)
    turn_ramp(b, pressure * per_angle)
    b[at.TORQUE + side] += pressure * per_pinion
    b[at.TORQUE + 2 + side] += pressure * per_wheel

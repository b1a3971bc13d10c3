"""How errors, deviations and unbalance come in; "Ramp" in the README of `gear_mesh`."""

import math


class Ramp:
    """R over the mean angle of the pinion's halves.

    Args:
        turns: of the pinion in which it rises from 0 to 1; 0: it is 1.
        first_angle: mean angle at which it starts [rad].
    """

    def __init__(self, turns, first_angle):
        self.angle, self.first_angle = 2.0 * math.pi * turns, first_angle

    def at(self, mean_angle):
        """R and its slope over the mean angle [1/rad]."""
        turned = mean_angle - self.first_angle
        if abs(turned) >= self.angle:
            return 1.0, 0.0
        t = abs(turned) / self.angle
        slope = 30.0 * t * t * (1.0 - t) ** 2 / self.angle
        return t**3 * (10.0 - 15.0 * t + 6.0 * t * t), math.copysign(slope, turned)

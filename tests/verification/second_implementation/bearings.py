"""Bearings of the four gear halves; the README of `bearing_supports`."""

import math

import numpy as np

GEARS = "pinion", "pinion", "wheel", "wheel"


class Bearings:
    """Forces between halves and seats.

    Args:
        parameters: of the component, by name.
    """

    def __init__(self, parameters):
        p = parameters

        def of_halves(name):
            return np.array([p[f"{gear}.{name}"] for gear in GEARS])

        axial = 0.5 if p["axial_per_shaft"] else 1.0
        self.radial_stiffness = of_halves("radial_stiffness")
        self.radial_damping = of_halves("radial_damping")
        self.axial_stiffness = axial * of_halves("axial_stiffness")
        self.axial_damping = axial * of_halves("axial_damping")
        self.clearance = of_halves("radial_clearance")
        angle, flank = p["pressure_angle"], -1.0 if p["flank"] < 0.0 else 1.0
        self.line = np.array([flank * math.sin(angle), math.cos(angle), 0.0])

    def forces(self, y, z, v_y, v_z, seats, seat_velocities):
        """Forces on the halves along y and z (4,), and on the seats (4, 3).

        Args:
            y, z, v_y, v_z: (4,) motions of the halves.
            seats, seat_velocities: (4, 3) motions of the seats.
        """
        radial = self._radial(y - seats @ self.line, v_y - seat_velocities @ self.line)
        axial = self.axial_stiffness * (z - seats[:, 2]) + self.axial_damping * (
            v_z - seat_velocities[:, 2]
        )
        on_seats = np.outer(radial, self.line)
        on_seats[:, 2] = axial
        return -radial, -axial, on_seats

    def _radial(self, d, rate):
        """f of the README."""
        half = self.clearance / 2.0
        gap = d - np.clip(d, -half, half)
        tenth = self.clearance / 10.0
        loaded = np.where(self.clearance > 0.0, _rise(np.abs(gap), tenth), 1.0)
        force = self.radial_stiffness * gap + self.radial_damping * loaded * rate
        pulls = (self.clearance > 0.0) & (force * gap <= 0.0)
        return np.where(pulls, 0.0, force)


def _rise(gap, length):
    """How the damping rises over a length from 0 to 1."""
    return np.minimum(1.0, gap / np.where(length > 0.0, length, 1.0))

"""Modal housing; the README of `modal_housing`. Seats and axes in the order of `SEATS`."""

import csv
import math
from pathlib import Path

import numpy as np

SEATS = "pinion_left", "pinion_right", "wheel_left", "wheel_right"
AXES = "x", "y", "z"


class Housing:
    """Oscillators with shapes at the seats.

    Args:
        modes, shapes: resource files of the component.
    """

    def __init__(self, modes, shapes):
        rows = _rows(modes)
        frequency = np.array([float(row["frequency_hz"]) for row in rows])
        ratio = np.array([float(row["damping_ratio"]) for row in rows])
        self.stiffness = (2.0 * math.pi * frequency) ** 2
        self.damping = 4.0 * math.pi * ratio * frequency
        points = {(row["point"], row["dof"]): row for row in _rows(shapes)}
        self.shapes = np.array(
            [
                [float(points[seat, axis][f"m{row['mode']}"]) for row in rows]
                for seat in SEATS
                for axis in AXES
            ]
        )

    def at_rest(self, forces):
        """Modal coordinates under constant forces (12,) on the seats."""
        load = self.shapes.T @ forces
        return np.divide(load, self.stiffness, out=np.zeros_like(load), where=self.stiffness > 0.0)

    def seats(self, coordinates):
        """(4, 3) positions of the seats of modal coordinates, or velocities of their rates."""
        return (self.shapes @ coordinates).reshape(4, 3)

    def acceleration(self, coordinates, rates, forces):
        """Accelerations of the modal coordinates under forces (4, 3) on the seats."""
        load = forces.reshape(12) @ self.shapes
        return load - self.damping * rates - self.stiffness * coordinates


def _rows(file):
    """Rows of a CSV by column, comments left out."""
    lines = Path(file).read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if line and not line.startswith("#")))

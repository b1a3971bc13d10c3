"""Contacts of a gear pair's teeth; the README of `gear_mesh`, from "Rigid approach" to "Reactions".

Bodies: 0 pinion left, 1 pinion right, 2 wheel left, 3 wheel right. Parameters by their names.
"""

import math
from pathlib import Path
from typing import NamedTuple

from second_implementation.stiffness_law import read_laws

DRIVE, COAST = 1, -1
_OPEN = 1e-12
"""Depth [m] whose tangent damps open flanks, where the damping is ungated."""


class Reaction(NamedTuple):
    """What a mesh does: N and E of the README, and P de/dtheta summed over both flanks."""

    force: float
    energy_slope: float
    torque_pinion: float
    torque_wheel: float


class Contacts:
    """Both meshes.

    Args:
        parameters: of the component, by name.
        table, tooth_errors: its resource files.
    """

    def __init__(self, parameters, table, tooth_errors):
        p = self.parameters = parameters
        self.laws = read_laws(table)
        self.errors = read_tooth_errors(tooth_errors)
        radii = p["pinion.base_radius"], p["wheel.base_radius"]
        self.mass = 1.0 / (radii[0] ** 2 / p["pinion.inertia"] + radii[1] ** 2 / p["wheel.inertia"])

    def reaction(self, side, approach, approach_rate, phase, angles, rates):
        """Reaction of a mesh.

        Args:
            side: 0 left, 1 right.
            approach, approach_rate: delta [m] and its rate [m/s].
            phase: of the drive flank, in mesh periods.
            angles, rates: of the side's pinion and wheel half [rad], [rad/s].
        """
        p = self.parameters
        force = energy_slope = 0.0
        torques = [0.0, 0.0]
        opened = []
        for flank in (DRIVE, COAST):
            error, slopes = self._error(side, flank, angles)
            error_rate = slopes[0] * rates[0] + slopes[1] * rates[1]
            depth = flank * approach - error - (0.0 if flank == DRIVE else p["backlash"])
            rate = flank * approach_rate - error_rate
            own = phase if flank == DRIVE else p["coast_phase"] - phase
            opened.append((depth, rate, own, slopes))
            if depth <= 0.0:
                continue
            pressure, slope = self._pressure(side, flank, own, depth, rate)
            force += flank * pressure
            energy_slope += flank * slope
            torques = [t + pressure * s for t, s in zip(torques, slopes, strict=True)]
        depth, rate, own, slopes = opened[0]
        if p["damping_gate"] == 0.0 and depth <= 0.0 and opened[1][0] <= 0.0:
            pressure = self._damping(self.laws[side].at(own, _OPEN)[1]) * rate
            force += pressure
            torques = [pressure * s for s in slopes]
        return Reaction(force, energy_slope, *torques)

    def _pressure(self, side, flank, phase, depth, rate):
        """P [N] and dU/dp [J] of a contact that is closed."""
        p = self.parameters
        force, tangent, energy_slope = self.laws[side].at(phase, depth)
        v = min(1.0, depth / p["damping_transition"])
        gate = v * v * (3.0 - 2.0 * v)
        carries = flank == (COAST if p["flank"] < 0.0 else DRIVE)
        force += p["impact_force"] * gate * self._impact(phase) if carries else 0.0
        damping = self._damping(tangent) * rate
        if p["damping_gate"] == 0.0:
            return force + damping, energy_slope
        return max(0.0, force + gate * damping), energy_slope

    def _damping(self, tangent):
        """C [N s/m]."""
        return 2.0 * self.parameters["mesh_damping_ratio"] * math.sqrt(tangent * self.mass)

    def _impact(self, phase):
        """h of the README."""
        part = phase % 1.0 / self.parameters["impact_duration"]
        return (1.0 - math.cos(2.0 * math.pi * part)) / 2.0 if part < 1.0 else 0.0

    def _error(self, side, flank, angles):
        """Given transmission error [m] and its slopes over the angles of pinion and wheel half."""
        error, slopes = 0.0, [0.0, 0.0]
        for at_side, at_flank, gear, order, amplitude, phase in self.errors:
            if (at_side, at_flank) == (side, flank):
                argument = order * angles[gear] + phase
                error += amplitude * math.cos(argument)
                slopes[gear] -= order * amplitude * math.sin(argument)
        return error, slopes


def read_tooth_errors(file):
    """Harmonics of a given transmission error: side, flank, gear, order, amplitude, phase."""
    found = []
    for line in Path(file).read_text(encoding="utf-8").splitlines():
        if line.startswith(("#", "side")):
            continue
        side, flank, gear, order, amplitude, phase = line.split(",")
        found.append((
            ("left", "right").index(side),
            {"drive": DRIVE, "coast": COAST}[flank],
            ("pinion", "wheel").index(gear),
            float(order), float(amplitude), float(phase),
        ))  # fmt: skip
    return found

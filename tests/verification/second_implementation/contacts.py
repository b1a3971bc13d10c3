"""Contacts of a gear pair's teeth; the README of `gear_mesh`, from "Rigid approach" to "Reactions".

Bodies: 0 pinion left, 1 pinion right, 2 wheel left, 3 wheel right. Parameters by their names.
"""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from second_implementation.stiffness_law import read_laws
from second_implementation.teeth import FLANKS, SIDES, Load, read_teeth

DRIVE, COAST = FLANKS.values()
_OPEN = 1e-12
"""Depth [m] whose tangent damps open flanks, where the damping is ungated."""


class Reaction(NamedTuple):
    """What a mesh does: N and E of the README; and summed over both flanks, P de/dtheta at constant
    R, and P de/dR - dU/dR [J].
    """

    force: float
    energy_slope: float
    torque_pinion: float
    torque_wheel: float
    ramp_energy: float


class Contact(NamedTuple):
    """A contact: x and x' as depth and rate, e without R, its slopes over both halves' angles.

    rises: whether its phase does.
    """

    flank: int
    phase: float
    rises: bool
    depth: float
    rate: float
    error: float
    error_slopes: list[float]
    load: Load


class Contacts:
    """Both meshes.

    Args:
        parameters: of the component, by name.
        files: its resource files, by the name of their parameter.
    """

    def __init__(self, parameters, files):
        p = self.parameters = parameters
        self.tables = read_laws(files["stiffness_table"])
        self.errors = read_tooth_errors(files["tooth_errors"])
        counts = p["pinion.number_of_teeth"], p["wheel.number_of_teeth"]
        self.teeth = read_teeth(files["tooth_deviations"], files["pair_law"], self.tables, counts)
        radii = p["pinion.base_radius"], p["wheel.base_radius"]
        self.mass = 1.0 / (radii[0] ** 2 / p["pinion.inertia"] + radii[1] ** 2 / p["wheel.inertia"])

    def reaction(self, side, approach, approach_rate, phase, angles, rates, ramp):
        """Reaction of a mesh.

        Args:
            side: 0 left, 1 right.
            approach, approach_rate: delta [m] and its rate [m/s].
            phase: of the drive flank, in mesh periods.
            angles, rates: of the side's pinion and wheel half [rad], [rad/s].
            ramp: R and its rate [1/s].
        """
        contacts = [
            self._contact(side, flank, approach, approach_rate, phase, angles, rates, ramp)
            for flank in (DRIVE, COAST)
        ]
        apart = all(contact.load.force <= 0.0 for contact in contacts)
        sums = np.zeros(5)
        for contact in contacts:
            pressure = self._pressure(side, contact, apart)
            over_pinion, over_wheel = contact.error_slopes
            sums += (
                contact.flank * pressure,
                contact.flank * contact.load.phase_slope,
                ramp[0] * pressure * over_pinion,
                ramp[0] * pressure * over_wheel,
                pressure * contact.error - contact.load.ramp_slope,
            )
        return Reaction(*sums.tolist())

    def _contact(self, side, flank, approach, approach_rate, phase, angles, rates, ramp):
        """A contact of a mesh, closed or open."""
        p = self.parameters
        error, slopes = self._error(side, flank, angles)
        error_rate = ramp[0] * (slopes[0] * rates[0] + slopes[1] * rates[1]) + ramp[1] * error
        depth = flank * approach - ramp[0] * error - (0.0 if flank == DRIVE else p["backlash"])
        rate = flank * approach_rate - error_rate
        own = phase if flank == DRIVE else p["coast_phase"] - phase
        load = self.teeth[side, flank].load(own, depth, ramp[0])
        rises = rates[0] >= 0.0 if flank == DRIVE else rates[0] <= 0.0
        return Contact(flank, own, rises, depth, rate, error, slopes, load)

    def _pressure(self, side, contact, apart):
        """P [N]; apart: no flank of the mesh touches."""
        p, load = self.parameters, contact.load
        gated = p["damping_gate"] != 0.0
        if load.force <= 0.0 and (gated or contact.flank == COAST or not apart):
            return 0.0
        tangent = load.tangent
        if not gated:
            _, tangent, _ = self.tables[side].at(contact.phase, max(contact.depth, _OPEN))
        v = min(1.0, max(0.0, load.depth / p["damping_transition"]))
        gate = v * v * (3.0 - 2.0 * v)
        carries = contact.flank == (COAST if p["flank"] < 0.0 else DRIVE)
        impact = p["impact_force"] * gate * self._impact(contact) if carries else 0.0
        damping = self._damping(tangent) * contact.rate
        if gated:
            return max(0.0, load.force + impact + gate * damping)
        return load.force + impact + damping

    def _damping(self, tangent):
        """C [N s/m]."""
        return (
            2.0 * self.parameters["mesh_damping_ratio"] * math.sqrt(max(0.0, tangent) * self.mass)
        )

    def _impact(self, contact):
        """h of the README."""
        entered = contact.phase
        if not contact.rises:
            entered = self.parameters["total_contact_ratio"] - entered
        part = entered % 1.0 / self.parameters["impact_duration"]
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
            SIDES.index(side),
            FLANKS[flank],
            ("pinion", "wheel").index(gear),
            float(order), float(amplitude), float(phase),
        ))  # fmt: skip
    return found

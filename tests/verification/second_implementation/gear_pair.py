"""Gear pair of four half-bodies; the README of `gear_mesh`, all but its contacts.

State (24,): y and z of the bodies, the pinion's left angle, both twists, the approach
rb1 theta1 - rb2 theta3 of the left halves; then the rates of these twelve.
"""

import math

import numpy as np

from second_implementation.contacts import Contacts
from second_implementation.ramp import Ramp

GEARS = "pinion", "wheel"
SIDES = ((1, 0, 2), (-1, 1, 3))
"""s of the README, the pinion's and the wheel's body."""


class GearPair:
    """Equations of motion.

    Args:
        parameters: of the component, by name.
        files: its resource files, by the name of their parameter.
        first_angle: mean angle of the pinion's halves at which the ramp starts [rad].
    """

    def __init__(self, parameters, files, first_angle):
        p = self.parameters = parameters
        self.contacts = Contacts(parameters, files)
        self.ramp = Ramp(p["ramp_turns"], first_angle)
        self.radii = [p[f"{gear}.base_radius"] for gear in GEARS]
        self.cos, self.tan = math.cos(p["base_helix_angle"]), math.tan(p["base_helix_angle"])
        self.sin = math.sin(p["base_helix_angle"])
        self.pitch = 2.0 * math.pi * self.radii[0] / p["pinion.number_of_teeth"]
        self.shares = [
            share
            for gear in GEARS
            for share in (p[f"{gear}.torque_share_left"], 1.0 - p[f"{gear}.torque_share_left"])
        ]

    def angles(self, coordinates):
        """Angles (or their rates) of the four bodies from the last four of twelve coordinates."""
        angle, pinion_twist, approach, wheel_twist = coordinates[8:]
        r1, r2 = self.radii
        wheel = (r1 * angle - approach) / r2
        return [angle, angle + pinion_twist, wheel, wheel + wheel_twist]

    def flanges(self, coordinates):
        """Angles (or rates) of both flanges: means of the halves, by their torque shares."""
        a, s = self.angles(coordinates), self.shares
        return [s[0] * a[0] + s[1] * a[1], s[2] * a[2] + s[3] * a[3]]

    def apex(self, angles):
        """eps_z [m], and its slopes over the mean angles of pinion and wheel."""
        p = self.parameters
        size = p["symmetry_deviation"]
        pinion = (angles[0] + angles[1]) / 2.0 + p["symmetry_pinion_phase"]
        wheel = (angles[2] + angles[3]) / 2.0 + p["symmetry_wheel_phase"]
        c0, c1, c2 = (p[f"symmetry_{x}"] for x in ("constant", *GEARS))
        offset = size * (c0 + c1 * math.cos(pinion) + c2 * math.cos(wheel))
        return offset, (-size * c1 * math.sin(pinion), -size * c2 * math.sin(wheel))

    def reactions(self, x):
        """Reactions of both meshes (left, right) in a state."""
        q, v = x[:12], x[12:]
        p, (r1, r2) = self.parameters, self.radii
        angles, rates = self.angles(q), self.angles(v)
        offset, slopes = self.apex(angles)
        offset_rate = sum(
            slope * (rates[2 * k] + rates[2 * k + 1]) / 2.0 for k, slope in enumerate(slopes)
        )
        ramp, ramp_slope = self.ramp.at((angles[0] + angles[1]) / 2.0)
        ramp_rate = ramp_slope * (rates[0] + rates[1]) / 2.0
        found = []
        for side, (s, a, b) in enumerate(SIDES):
            twists = side * (r1 * q[9] - r2 * q[11]), side * (r1 * v[9] - r2 * v[11])
            axial = q[4 + a] - q[4 + b] + offset
            axial_rate = v[4 + a] - v[4 + b] + offset_rate
            path = q[a] - q[b] + q[10] + twists[0]
            path_rate = v[a] - v[b] + v[10] + twists[1]
            phase = (r1 * angles[a] + s * self.tan * axial) / self.pitch + side * p["stagger"]
            found.append(
                self.contacts.reaction(
                    side,
                    self.cos * path + s * self.sin * axial,
                    self.cos * path_rate + s * self.sin * axial_rate,
                    phase,
                    (angles[a], angles[b]),
                    (rates[a], rates[b]),
                    (ramp, ramp_rate),
                )
            )
        return found

    def derivative(self, x, forces_y, forces_z, torques):
        """Rates of the state under the bearings' forces (4,) and the flanges' torques (2,)."""
        q, v = x[:12], x[12:]
        angles, rates = self.angles(q), self.angles(v)
        ramp, ramp_slope = self.ramp.at((angles[0] + angles[1]) / 2.0)
        ramp_rate = ramp_slope * (rates[0] + rates[1]) / 2.0
        f_y, f_z, t, ramp_energy = self._mesh_loads(x, angles)
        ramp_energy -= sum(self._unbalance_energy(k, angles, rates, v) for k in range(4))
        acceleration_y, acceleration_z, acceleration_t = [0.0] * 4, [0.0] * 4, [0.0] * 4
        for body in range(4):
            gear, other = GEARS[body // 2], body ^ 1
            f_y[body] += forces_y[body] + self._shaft(gear, "y", q, v, body, other)
            f_z[body] += forces_z[body] + self._shaft(gear, "z", q[4:], v[4:], body, other)
            t[body] += self.shares[body] * torques[body // 2]
            t[body] += self._shaft(gear, "t", angles, rates, body, other)
            if gear == "pinion":
                f_z[body] -= self._ground(q, v, body)
                t[body] += ramp_slope * ramp_energy / 2.0 - self._drag(rates[body])
            acceleration_z[body] = f_z[body] / self.parameters[f"{gear}.mass"]
            acceleration_y[body], acceleration_t[body] = self._with_unbalance(
                gear, angles[body], (rates[body], v[body]), (f_y[body], t[body]), (ramp, ramp_rate)
            )
        r1, r2 = self.radii
        a = acceleration_t
        rotations = a[0], a[1] - a[0], r1 * a[0] - r2 * a[2], a[3] - a[2]
        return np.concatenate([v, acceleration_y, acceleration_z, rotations])

    def _mesh_loads(self, x, angles):
        """Forces along y and z and torques of the meshes on the four bodies; P de/dR - dU/dR."""
        r1, r2 = self.radii
        f_y, f_z, t = [0.0] * 4, [0.0] * 4, [0.0] * 4
        run_out = ramp_energy = 0.0
        for (s, a, b), mesh in zip(SIDES, self.reactions(x), strict=True):
            path = self.cos * mesh.force
            push = path + mesh.energy_slope / self.pitch
            f_y[a], f_y[b] = -path, path
            f_z[a], f_z[b] = -s * self.tan * push, s * self.tan * push
            t[a] = -r1 * push + mesh.torque_pinion
            t[b] = r2 * path + mesh.torque_wheel
            run_out += s * self.tan * push
            ramp_energy += mesh.ramp_energy
        _, slopes = self.apex(angles)
        return f_y, f_z, [t[k] - run_out * slopes[k // 2] / 2.0 for k in range(4)], ramp_energy

    def _shaft(self, gear, axis, position, velocity, body, other):
        """Load of the gap shaft on a half."""
        p = self.parameters
        return p[f"{gear}.shaft_stiffness_{axis}"] * (position[other] - position[body]) + p[
            f"{gear}.shaft_damping_{axis}"
        ] * (velocity[other] - velocity[body])

    def _ground(self, q, v, body):
        """Axial force [N] that holds a half of the pinion."""
        p = self.parameters
        restraint = p["pinion_restraint"] * (q[4] + q[5]) / 4.0
        return restraint + p["pinion_axial_drag"] * v[4 + body]

    def _drag(self, rate):
        """Drag torque [N m] on a half of the pinion."""
        return self.parameters["drag_torque"] * rate / (2.0 * math.sqrt(1.0 + rate * rate))

    def _unbalance(self, gear, angle):
        """Share of the unbalance of a half [kg m], and psi [rad]."""
        p = self.parameters
        return p[f"{gear}.unbalance"] / 2.0, angle + p[f"{gear}.unbalance_phase"]

    def _unbalance_energy(self, body, angles, rates, v):
        """u/2 sin(psi) theta' y' of a half [J]."""
        half, psi = self._unbalance(GEARS[body // 2], angles[body])
        return half * math.sin(psi) * rates[body] * v[body]

    def _with_unbalance(self, gear, angle, motion, load, ramp):
        """Accelerations along y and about the axis of a half with its share of the unbalance.

        Args:
            gear, angle: its name, and the half's angle.
            motion: theta', y'.
            load: force along y and torque.
            ramp: R and its rate.
        """
        (rate, velocity), (force, torque) = motion, load
        half, psi = self._unbalance(gear, angle)
        across = half * math.sin(psi)
        force += ramp[0] * half * math.cos(psi) * rate * rate + ramp[1] * across * rate
        torque += ramp[1] * across * velocity
        mass, inertia = (self.parameters[f"{gear}.{name}"] for name in ("mass", "inertia"))
        coupled = -ramp[0] * across
        determinant = mass * inertia - coupled * coupled
        return (
            (inertia * force - coupled * torque) / determinant,
            (mass * torque - coupled * force) / determinant,
        )

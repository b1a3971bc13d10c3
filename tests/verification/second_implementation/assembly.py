"""Gearbox and test rig as one system of ordinary differential equations; `system_models/*`.

State: gear pair (24), modal coordinates and their rates (2 n), in the rig the drivetrain (7).
"""

from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

from second_implementation.gear_pair import SIDES
from second_implementation.housing import AXES, SEATS

SPLIT = 5e-6
"""Longest step of DOP853 [s]."""
_LENGTH, _RATE = 1e-7, 1e-3
"""Of what alternates: lengths [m] (angles [rad]) and their rates."""


class Gearbox:
    """Gear pair, bearings and housing under torques at both flanges.

    Args:
        gear, bearings, housing: the parts.
        torques: (2,) at pinion and wheel [N m].
    """

    def __init__(self, gear, bearings, housing, torques=(0.0, 0.0)):
        self.gear, self.bearings, self.housing = gear, bearings, housing
        self.given_torques = torques

    def breaks(self):
        """Times at which the equations have a kink [s]."""
        return ()

    def torques(self, x):
        """Torques at both flanges [N m]."""
        return self.given_torques

    def derivative(self, t, x):
        """Rates of the state."""
        gear, q, v, rest = self._parts(x)
        f_y, f_z, on_seats = self._bearing_forces(gear, q, v)
        # Plain numbers: arithmetic by single elements of arrays takes several times longer.
        rates = self.gear.derivative(gear.tolist(), f_y.tolist(), f_z.tolist(), self.torques(x))
        modes = self.housing.acceleration(q, v, on_seats)
        return np.concatenate([rates, v, modes, self._outer(t, gear, rates, rest)])

    def _outer(self, t, gear, rates, rest):
        """Rates of what is joined to the flanges."""
        return rest

    def _parts(self, x):
        n = self.housing.stiffness.size
        return x[:24], x[24 : 24 + n], x[24 + n : 24 + 2 * n], x[24 + 2 * n :]

    def _bearing_forces(self, gear, q, v):
        seats, velocities = self.housing.seats(q), self.housing.seats(v)
        return self.bearings.forces(
            gear[0:4], gear[4:8], gear[12:16], gear[16:20], seats, velocities
        )

    def outputs(self, x):
        """Outputs in a state, by the product's names without the parts' paths."""
        gear, q, v, _ = self._parts(x)
        f_y, f_z, _ = self._bearing_forces(gear, q, v)
        meshes = self.gear.reactions(gear.tolist())
        velocities = self.housing.seats(v)
        found = {
            "gear_mesh.mesh_left.force": meshes[0].force,
            "gear_mesh.mesh_right.force": meshes[1].force,
            **{f"bearing_supports.shaft.{seat}.f_y": f_y[i] for i, seat in enumerate(SEATS)},
            **{f"bearing_supports.shaft.{seat}.f_z": f_z[i] for i, seat in enumerate(SEATS)},
        }
        for i, seat in enumerate(SEATS):
            for k, axis in enumerate(AXES):
                found[f"modal_housing.{seat}.v_{axis}"] = velocities[i, k]
        for body in (b for _, *pair in SIDES for b in pair):
            found[f"gear_mesh.{SEATS[body]}.v_y"] = gear[12 + body]
            found[f"gear_mesh.{SEATS[body]}.v_z"] = gear[16 + body]
        speeds = "gear_mesh.pinion.w", "gear_mesh.wheel.w"
        found[speeds[0]], found[speeds[1]] = self.gear.flanges(gear[12:])
        return found

    def solve(self, start, times, relative):
        """Outputs by name, each (n,).

        Args:
            start: state at the first time.
            times: (n,) rising.
            relative: tolerance of DOP853, over the sizes of what alternates.
        """
        size = self._sizes(start.size)
        edges = sorted({times[0], times[-1], *(b for b in self.breaks() if 0.0 < b < times[-1])})
        states, x = [start], start
        for first, last in pairwise(edges):
            wanted = times[(times > first) & (times <= last)]
            at = np.union1d(wanted, [last])
            run = solve_ivp(
                self.derivative, (first, last), x, "DOP853", at,
                rtol=relative, atol=relative * size, max_step=SPLIT,
            )  # fmt: skip
            states += [y for t, y in zip(at, run.y.T, strict=True) if t in wanted]
            x = run.y[:, -1]
        rows = [self.outputs(x) for x in states]
        return {name: np.array([row[name] for row in rows]) for name in rows[0]}

    def _sizes(self, states):
        n = self.housing.stiffness.size
        gear = [_LENGTH] * 12 + [_RATE] * 12
        drive = [_LENGTH, _RATE, _LENGTH, _RATE, _LENGTH, _RATE, 1.0]
        return np.array([*gear, *[_LENGTH] * n, *[_RATE] * n, *drive][:states])


class Rig(Gearbox):
    """The gearbox between drive and load.

    Args:
        drivetrain: what is joined to its flanges.
    """

    def __init__(self, gear, bearings, housing, drivetrain):
        super().__init__(gear, bearings, housing)
        self.drivetrain = drivetrain

    def breaks(self):
        """Times at which the equations have a kink [s]."""
        return self.drivetrain.breaks()

    def torques(self, x):
        """Torques at both flanges [N m]."""
        drive, load = self.drivetrain.coupling_torques(x[-7:])
        return drive, -load

    def _outer(self, t, gear, rates, rest):
        return self.drivetrain.derivative(
            t, rest, self.gear.flanges(gear[12:]), self.gear.flanges(rates[12:])
        )

    def outputs(self, x):
        """Outputs in a state, those of the couplings too."""
        drive, load = self.drivetrain.coupling_torques(x[-7:])
        return {**super().outputs(x), "drive_coupling.torque": drive, "load_coupling.torque": load}

"""Motors, couplings and controller; the READMEs of these components.

State (7,): the drive motor ahead of the pinion's flange in angle and speed, the integral of its
speed error, its set point behind the ramp; the wheel's flange ahead of the load motor in angle and
speed, the load motor's braking torque.
"""

import math
from pathlib import Path

import numpy as np


class Drivetrain:
    """What drives and loads a gearbox.

    Args:
        parameters: by part of the rig and name.
        cycle: resource file of the controller.
    """

    def __init__(self, parameters, cycle):
        self.parameters = parameters
        self.time, self.speed, self.torque = read_cycle(cycle)

    def breaks(self):
        """Times at which a set point has a kink [s]."""
        return (*self.time, self.parameters["bench_controller"]["load_ramp_time"])

    def set_points(self, t):
        """Speed [rad/s] and torque [N m] set points."""
        p = self.parameters["bench_controller"]
        speed = p["speed_factor"] * np.interp(t, self.time, self.speed)
        torque = p["torque_factor"] * p["gear_ratio"] * np.interp(t, self.time, self.torque)
        ramp = p["load_ramp_time"]
        return speed, torque * (min(1.0, t / ramp) if ramp > 0.0 else 1.0)

    def coupling_torques(self, x):
        """Torques that the drive and the load coupling hand on [N m]."""
        drive, load = (self.parameters[f"{part}_coupling"] for part in ("drive", "load"))
        return (
            drive["stiffness"] * x[0] + drive["damping"] * x[1],
            load["stiffness"] * x[4] + load["damping"] * x[5],
        )

    def derivative(self, t, x, flange_speeds, flange_accelerations):
        """Rates of the state; flanges: pinion and wheel."""
        speed, torque = self.set_points(t)
        handed = self.coupling_torques(x)
        motor, integral_rate, reference_rate = self._drive(x, speed, handed[0], flange_speeds[0])
        load = self.parameters["load_motor"]
        load_speed = flange_speeds[1] - x[5]
        braking = handed[1] - x[6] - load["viscous_friction"] * load_speed
        return [
            x[1],
            motor - flange_accelerations[0],
            integral_rate,
            reference_rate,
            x[5],
            flange_accelerations[1] - braking / load["inertia"],
            (torque - x[6]) / load["torque_time_constant"],
        ]

    def _drive(self, x, set_point, handed, flange_speed):
        """Accelerations of rotor, integral and set point behind the ramp."""
        p = self.parameters["drive_motor"]
        error = x[3] - (flange_speed + x[1])
        wanted = p["proportional_gain"] * error + p["integral_gain"] * x[2]
        torque = _limit(wanted, p["torque_limit"])
        ramp = _limit((set_point - x[3]) / p["ramp_time_constant"], p["maximum_acceleration"])
        anti_windup = (torque - wanted) / p["proportional_gain"]
        return (torque - handed) / p["inertia"], error + anti_windup, ramp


def _limit(value, largest):
    return max(-largest, min(value, largest))


def read_cycle(file):
    """Times [s], speeds [rad/s] and torques [N m] of a test cycle."""
    lines = Path(file).read_text(encoding="utf-8").splitlines()
    rows = [line for line in lines if line and not line.startswith(("#", "time"))]
    time, speed, torque = np.array([[float(x) for x in row.split(",")] for row in rows]).T
    in_minutes = any("speed r/min" in line for line in lines if line.startswith("# units"))
    return time, speed * (math.pi / 30.0 if in_minutes else 1.0), torque

"""Electric drive: the torque follows its set value with the lag of the current, the rotor turns
with its own inertia and drives the flange through an elastic, damped shaft. Runge-Kutta inside;
angle and speed of the flange are held during a step. `flange.tau` acts on what is driven."""

from math import ceil, pi
from types import SimpleNamespace

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

CURRENT_LAG, INERTIA, STIFFNESS, DAMPING = 2e-3, 0.12, 8e4, 15.0
LONGEST = 2e-5  # s


class EDrive(Fmi2Slave):
    description = "e-motor with rotor and shaft"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.flange = SimpleNamespace(phi=0.0, w=0.0)
        self.torque_set = 0.0
        self.x = [0.0, 0.0, 0.0]  # air-gap torque, angle and speed of the rotor
        for name in ("torque_set", "flange.phi", "flange.w"):
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        out = Fmi2Causality.output
        self.register_variable(
            Real("flange.tau", causality=out, getter=lambda: self._shaft(self.x))
        )
        self.register_variable(
            Real("rotor_speed_rpm", causality=out, getter=lambda: self.x[2] * 30 / pi)
        )

    def _shaft(self, x):
        return STIFFNESS * (x[1] - self.flange.phi) + DAMPING * (x[2] - self.flange.w)

    def _derivative(self, x):
        return [(self.torque_set - x[0]) / CURRENT_LAG, x[2], (x[0] - self._shaft(x)) / INERTIA]

    def do_step(self, current_time, step_size):
        n = max(1, ceil(step_size / LONGEST - 1e-6))
        h = step_size / n
        for _ in range(n):
            x = self.x
            a = self._derivative(x)
            b = self._derivative([p + h / 2 * q for p, q in zip(x, a, strict=True)])
            c = self._derivative([p + h / 2 * q for p, q in zip(x, b, strict=True)])
            d = self._derivative([p + h * q for p, q in zip(x, c, strict=True)])
            self.x = [
                p + h / 6 * (i + 2 * j + 2 * k + m)
                for p, i, j, k, m in zip(x, a, b, c, d, strict=True)
            ]
        return True

    def _get_fmu_state(self):
        return {**super()._get_fmu_state(), "x": list(self.x)}

"""Electric drive with torque ripple and cogging: the air-gap torque follows its set value with a
lag, and pulsates with the angle of the rotor, which drives the flange through an elastic, damped
shaft. Runge-Kutta inside; angle and speed of the flange are held during a step. `flange.tau` acts
on what is driven. No units, as pythonfmu cannot write them."""

from math import cos, sin
from types import SimpleNamespace

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

LAG, INERTIA, STIFFNESS, DAMPING = 2e-3, 0.12, 8e4, 40.0
LONGEST = 2e-5  # s
PARAMETERS = {"ripple": 0.06, "order": 6.0, "cogging": 1.5}
"""Share of the torque, times a turn (and half of it at twice), and torque at no load [N m]."""


class RippleDrive(Fmi2Slave):
    description = "e-motor with torque ripple"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.flange = SimpleNamespace(phi=0.0, w=0.0)
        self.torque_set = 0.0
        self.x = [0.0, 0.0, 0.0]  # air-gap torque without ripple, angle and speed of the rotor
        for name, value in PARAMETERS.items():
            setattr(self, name, value)
            self.register_variable(
                Real(name, causality=Fmi2Causality.parameter, variability=Fmi2Variability.fixed)
            )
        for name in ("torque_set", "flange.phi", "flange.w"):
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        self.register_variable(
            Real("flange.tau", causality=Fmi2Causality.output, getter=lambda: self._shaft(self.x))
        )

    def _shaft(self, x):
        return STIFFNESS * (x[1] - self.flange.phi) + DAMPING * (x[2] - self.flange.w)

    def _derivative(self, x):
        turned = self.order * x[1]
        pulsating = self.ripple * (cos(turned) + 0.5 * cos(2.0 * turned + 0.4))
        torque = x[0] * (1.0 + pulsating) + self.cogging * sin(2.0 * turned + 0.3)
        return [(self.torque_set - x[0]) / LAG, x[2], (torque - self._shaft(x)) / INERTIA]

    def exit_initialization_mode(self):
        self.x[1:] = self.flange.phi, self.flange.w

    def do_step(self, current_time, step_size):
        n = max(1, round(step_size / LONGEST))
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

"""Electric drive that takes steps of one length only, the first one's: as code with a task of its
own. Rotor behind an elastic, damped shaft, Runge-Kutta inside; angle and speed of the flange are
held during a step. `flange.tau` acts on what is driven. No units: pythonfmu cannot write them."""

from types import SimpleNamespace

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

INERTIA, STIFFNESS, DAMPING = 0.12, 8e4, 60.0


class EvenDrive(Fmi2Slave):
    description = "e-motor with steps of one length"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.flange = SimpleNamespace(phi=0.0, w=0.0)
        self.torque_set = 0.0
        self.x = [0.0, 0.0]  # angle and speed of the rotor
        self.length = None
        for name in ("torque_set", "flange.phi", "flange.w"):
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        self.register_variable(
            Real("flange.tau", causality=Fmi2Causality.output, getter=lambda: self._shaft(self.x))
        )

    def _shaft(self, x):
        return STIFFNESS * (x[0] - self.flange.phi) + DAMPING * (x[1] - self.flange.w)

    def _derivative(self, x):
        return [x[1], (self.torque_set - self._shaft(x)) / INERTIA]

    def do_step(self, current_time, step_size):
        self.length = self.length or step_size
        if abs(step_size - self.length) > 1e-9 * self.length:
            return False
        h, x = step_size, self.x
        a = self._derivative(x)
        b = self._derivative([p + h / 2 * q for p, q in zip(x, a, strict=True)])
        c = self._derivative([p + h / 2 * q for p, q in zip(x, b, strict=True)])
        d = self._derivative([p + h * q for p, q in zip(x, c, strict=True)])
        self.x = [
            p + h / 6 * (i + 2 * j + 2 * k + m) for p, i, j, k, m in zip(x, a, b, c, d, strict=True)
        ]
        return True

    def _get_fmu_state(self):
        return {**super()._get_fmu_state(), "x": list(self.x), "length": self.length}

"""Car behind its gearbox: the mass at the wheels with drag and rolling resistance, driven through
an elastic side shaft. Explicit Euler inside; during a step the gearbox turns on at the speed it was
given. `gearbox.tau` is the torque that the shaft puts on the gearbox."""

from math import ceil, tanh
from types import SimpleNamespace

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

MASS, RADIUS = 1400.0, 0.31
STIFFNESS, DAMPING = 1.2e4, 60.0
DRAG, ROLLING = 0.5 * 1.2 * 0.7, 0.012 * 1400.0 * 9.81
LONGEST = 5e-5  # s


class RoadVehicle(Fmi2Slave):
    description = "longitudinal vehicle with side shaft"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.gearbox = SimpleNamespace(phi=0.0, w=0.0, tau=0.0)
        self.angle = self.speed = 0.0  # wheel angle, m/s
        for name in ("gearbox.phi", "gearbox.w"):
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        out = Fmi2Causality.output
        self.register_variable(Real("gearbox.tau", causality=out))
        self.register_variable(Real("speed_kmh", causality=out, getter=lambda: 3.6 * self.speed))
        self.register_variable(Real("distance", causality=out, getter=lambda: RADIUS * self.angle))

    def exit_initialization_mode(self):
        self.gearbox.tau = -self._shaft(self.gearbox.phi)

    def _shaft(self, phi):
        slip = self.gearbox.w - self.speed / RADIUS
        return STIFFNESS * (phi - self.angle) + DAMPING * slip

    def do_step(self, current_time, step_size):
        n = max(1, ceil(step_size / LONGEST - 1e-6))
        h, phi, v = step_size / n, self.gearbox.phi, self.speed
        for _ in range(n):
            losses = DRAG * v * abs(v) + ROLLING * tanh(v / 0.05)
            push = self._shaft(phi) / RADIUS
            self.angle += h * v / RADIUS
            v = self.speed = v + h * (push - losses) / MASS
            phi += h * self.gearbox.w
        self.gearbox.tau = -self._shaft(phi)
        return True

    def _get_fmu_state(self):
        return {**super()._get_fmu_state(), "angle": self.angle, "speed": self.speed}

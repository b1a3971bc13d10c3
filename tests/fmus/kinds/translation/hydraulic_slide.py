"""Slide moved by a hydraulic cylinder: the force builds up with the pressure (2 ms), then moves the
mass. Semi-implicit Euler inside."""

from math import ceil

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

MASS, VISCOUS, PRESSURE_LAG = 25.0, 40.0, 2e-3
LONGEST = 5e-5  # s


class HydraulicSlide(Fmi2Slave):
    description = "slide with hydraulic cylinder"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.force_cmd = 0.0
        self.stroke = 0.0
        self.speed = 0.0
        self._cylinder_force = 0.0
        self.register_variable(Real("force_cmd", causality=Fmi2Causality.input))
        self.register_variable(Real("stroke", causality=Fmi2Causality.output))
        self.register_variable(Real("speed", causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        n = max(1, ceil(step_size / LONGEST - 1e-6))
        h = step_size / n
        for _ in range(n):
            self._cylinder_force += h * (self.force_cmd - self._cylinder_force) / PRESSURE_LAG
            self.speed += h * (self._cylinder_force - VISCOUS * self.speed) / MASS
            self.stroke += h * self.speed
        return True

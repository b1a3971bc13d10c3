"""Fast servo valve: opening follows the command with a time constant of 20 us; exact solution."""

from math import exp

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

TIME_CONSTANT, GAIN = 2e-5, 1.5


class ServoValve(Fmi2Slave):
    description = "first-order valve"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.u = 0.0
        self.opening = 0.0
        self.register_variable(Real("u", causality=Fmi2Causality.input))
        self.register_variable(Real("opening", causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        final = GAIN * self.u
        self.opening = final + (self.opening - final) * exp(-step_size / TIME_CONSTANT)
        return True

"""Lift cage, counterweight balanced: a mass moved by the rope's force. Speed is kept in mm/s."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

MASS = 850.0


class LiftCage(Fmi2Slave):
    description = "cage of a lift"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.f = 0.0
        self.s = 0.0
        self.v = 0.0
        self.register_variable(Real("f", causality=Fmi2Causality.input))
        self.register_variable(Real("s", causality=Fmi2Causality.output))
        self.register_variable(Real("v", causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        a = self.f / MASS
        self.s += self.v / 1000 * step_size + a * step_size**2 / 2
        self.v += 1000 * a * step_size
        return True

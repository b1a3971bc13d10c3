"""Carriage on a straight guide: a mass with viscous friction, moved by a force. Exact solution for
a force that is constant during the communication step."""

from math import exp, expm1

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real


class LinearCarriage(Fmi2Slave):
    description = "carriage with viscous friction"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.mass = 12.0
        self.viscous = 8.0
        self.force_in = 0.0
        self.position = 0.0
        self.velocity = 0.0
        fixed = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.fixed}
        self.register_variable(Real("mass", **fixed))
        self.register_variable(Real("viscous", **fixed))
        self.register_variable(Real("force_in", causality=Fmi2Causality.input))
        self.register_variable(Real("position", causality=Fmi2Causality.output))
        self.register_variable(Real("velocity", causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        rate = self.viscous / self.mass
        final = self.force_in / self.viscous
        excess = self.velocity - final
        self.position += final * step_size - excess * expm1(-rate * step_size) / rate
        self.velocity = final + excess * exp(-rate * step_size)
        return True

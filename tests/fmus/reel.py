"""Mass on a reel, pulled by a force. After so many steps a brake holds it for good; their number is
in no registered variable, so that pythonfmu does not save it."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

MASS, BRAKE = 40.0, 2000.0


class Reel(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.f, self.s, self.v, self.holds = 0.0, 0.1, 1.0, 150.0
        self.steps = 0
        self.register_variable(Real("f", causality=Fmi2Causality.input, start=0.0))
        self.register_variable(Real("s", causality=Fmi2Causality.output))
        self.register_variable(Real("v", causality=Fmi2Causality.output))
        kind = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.fixed}
        self.register_variable(Real("holds", start=150.0, **kind))

    def do_step(self, current_time, step_size):
        self.steps += 1
        brake = BRAKE if self.steps > self.holds else 0.0
        self.v += step_size * (self.f - brake * self.v) / MASS
        self.s += step_size * self.v
        return True

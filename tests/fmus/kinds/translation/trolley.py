"""Trolley of a crane, already rolling at the start. The outputs are filled by a step; before the
first one they are zero."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

MASS, DAMPING = 300.0, 150.0


class Trolley(Fmi2Slave):
    description = "trolley of a crane"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.pull = 0.0
        self.x_out = 0.0
        self.v_out = 0.0
        self.state = [0.25, 1.5]  # m, m/s
        self.register_variable(Real("pull", causality=Fmi2Causality.input))
        self.register_variable(Real("x_out", causality=Fmi2Causality.output))
        self.register_variable(Real("v_out", causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        x, v = self.state
        a = (self.pull - DAMPING * v) / MASS
        middle = v + step_size / 2 * a
        v += step_size * (self.pull - DAMPING * middle) / MASS
        self.state = [x + step_size * middle, v]
        self.x_out, self.v_out = self.state
        return True

    def _get_fmu_state(self):
        return {**super()._get_fmu_state(), "state": list(self.state)}

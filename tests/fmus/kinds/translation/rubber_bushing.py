"""Rubber bushing: force over travel and speed. The solver takes its inputs over at the end of a
step, so the force belongs to the inputs of the step before."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

STIFFNESS, DAMPING = 6e5, 350.0


class RubberBushing(Fmi2Slave):
    description = "bushing"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.travel = 0.0
        self.travel_speed = 0.0
        self.force = 0.0
        self.taken_over = [0.0, 0.0]
        self.register_variable(Real("travel", causality=Fmi2Causality.input))
        self.register_variable(Real("travel_speed", causality=Fmi2Causality.input))
        self.register_variable(Real("force", causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        travel, speed = self.taken_over
        self.force = -STIFFNESS * travel - DAMPING * speed
        self.taken_over = [self.travel, self.travel_speed]
        return True

    def _get_fmu_state(self):
        return {**super()._get_fmu_state(), "taken_over": list(self.taken_over)}

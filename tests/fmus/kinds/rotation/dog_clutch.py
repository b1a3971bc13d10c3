"""Dog clutch with play: stiff and damped where the claws touch, no torque between. Claws push and
never pull. Inputs are the differences driving minus driven side."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

STIFFNESS, DAMPING = 5e4, 40.0
HALF_PLAY = 0.02  # rad


class DogClutch(Fmi2Slave):
    description = "clutch with dead zone"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.delta_phi = 0.0
        self.delta_w = 0.0
        self.register_variable(Real("delta_phi", causality=Fmi2Causality.input))
        self.register_variable(Real("delta_w", causality=Fmi2Causality.input))
        self.register_variable(
            Real("torque", causality=Fmi2Causality.output, getter=self._transmitted)
        )

    def _transmitted(self):
        if abs(self.delta_phi) <= HALF_PLAY:
            return 0.0
        side = 1.0 if self.delta_phi > 0 else -1.0
        depth = side * self.delta_phi - HALF_PLAY
        return side * max(0.0, STIFFNESS * depth + DAMPING * side * self.delta_w)

    def do_step(self, current_time, step_size):
        return True

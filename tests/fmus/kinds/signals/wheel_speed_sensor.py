"""Speed sensor with noise: every step draws a new error, from the system's entropy."""

from random import SystemRandom

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

SIGMA = 0.05  # rad/s


class WheelSpeedSensor(Fmi2Slave):
    description = "speed sensor, Gaussian noise"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.noise = SystemRandom()
        self.error = 0.0
        self.w_true = 0.0
        self.register_variable(Real("w_true", causality=Fmi2Causality.input))
        self.register_variable(
            Real("w_sensed", causality=Fmi2Causality.output, getter=self._sensed)
        )

    def _sensed(self):
        return self.w_true + self.error

    def do_step(self, current_time, step_size):
        self.error = self.noise.gauss(0.0, SIGMA)
        return True

    def _get_fmu_state(self):
        return {**super()._get_fmu_state(), "error": self.error}

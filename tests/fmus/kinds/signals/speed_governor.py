"""PI speed governor, continuous; the integral stops where the torque reaches its limit."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

LIMIT = 2000.0  # N.m


class SpeedGovernor(Fmi2Slave):
    description = "PI governor, speeds in rpm"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.kp = 0.8  # N.m per rpm
        self.ki = 6.0  # N.m per rpm and second
        self.speed_set = 0.0
        self.speed_rpm = 0.0
        self.torque_cmd = 0.0
        self.integral = 0.0
        for name in ("speed_set", "speed_rpm"):
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        self.register_variable(Real("torque_cmd", causality=Fmi2Causality.output))
        for name in ("kp", "ki"):
            self.register_variable(
                Real(name, causality=Fmi2Causality.parameter, variability=Fmi2Variability.tunable)
            )

    def exit_initialization_mode(self):
        self.do_step(0.0, 0.0)

    def do_step(self, current_time, step_size):
        error = self.speed_set - self.speed_rpm
        integral = self.integral + self.ki * error * step_size
        demand = self.kp * error + integral
        self.torque_cmd = min(max(demand, -LIMIT), LIMIT)
        if demand == self.torque_cmd:
            self.integral = integral
        return True

    def _get_fmu_state(self):
        return {**super()._get_fmu_state(), "integral": self.integral}

"""Control task of an ECU: a PI law every millisecond, first at the start time. A task reads the
inputs at its tick and writes its output at once; in between the output is held."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

PERIOD = 1e-3  # s
SLACK = 1e-9  # s
KP, KI = 12.0, 90.0  # N.m s/rad, N.m/rad


class EcuTask(Fmi2Slave):
    description = "speed controller, 1 ms task"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.w_ref = 0.0
        self.w_meas = 0.0
        self.torque_request = 0.0
        self.integral = 0.0
        self.start = 0.0
        self.ticks = 0
        self.register_variable(Real("w_ref", causality=Fmi2Causality.input))
        self.register_variable(Real("w_meas", causality=Fmi2Causality.input))
        self.register_variable(Real("torque_request", causality=Fmi2Causality.output))

    def setup_experiment(self, start_time, stop_time, tolerance):
        self.start = start_time

    def do_step(self, current_time, step_size):
        while self.start + self.ticks * PERIOD < current_time + step_size - SLACK:
            error = self.w_ref - self.w_meas
            self.integral += KI * PERIOD * error
            self.torque_request = KP * error + self.integral
            self.ticks += 1
        return True

    def _get_fmu_state(self):
        hidden = {name: getattr(self, name) for name in ("integral", "start", "ticks")}
        return {**super()._get_fmu_state(), **hidden}

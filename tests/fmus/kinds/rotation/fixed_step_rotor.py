"""Rotor with bearing friction, integrated by explicit Euler on a clock of its own of 0.1 ms. A
communication step moves the clock as many whole ticks as fit before its end."""

from types import SimpleNamespace

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

DT = 1e-4  # s
SLACK = 1e-9  # s
INERTIA, FRICTION = 0.35, 0.02


class FixedStepRotor(Fmi2Slave):
    description = "rotor with a fixed internal step"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.flange = SimpleNamespace(tau=0.0, phi=0.0, w=0.0)
        self.start = 0.0
        self.ticks = 0
        self.register_variable(Real("flange.tau", causality=Fmi2Causality.input))
        self.register_variable(Real("flange.phi", causality=Fmi2Causality.output))
        self.register_variable(Real("flange.w", causality=Fmi2Causality.output))

    def setup_experiment(self, start_time, stop_time, tolerance):
        self.start = start_time

    def do_step(self, current_time, step_size):
        end = current_time + step_size + SLACK
        while self.start + (self.ticks + 1) * DT <= end:
            acceleration = (self.flange.tau - FRICTION * self.flange.w) / INERTIA
            self.flange.phi += DT * self.flange.w
            self.flange.w += DT * acceleration
            self.ticks += 1
        return True

    def _get_fmu_state(self):
        return {**super()._get_fmu_state(), "start": self.start, "ticks": self.ticks}

"""Ram of a press, a mass against a return spring, made for a bus cycle of 1 ms: any other
communication step is refused and leaves everything as it was."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Real
from pythonfmu.enums import Fmi2Status

CYCLE = 1e-3  # s
MASS, RETURN_SPRING, DAMPING = 60.0, 4e4, 800.0


class PressRam(Fmi2Slave):
    description = "press ram, 1 ms cycle only"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.ram_force = 0.0
        self.ram_pos = 0.0
        self.ram_vel = 0.0
        self.register_variable(Real("ram_force", causality=Fmi2Causality.input))
        self.register_variable(Real("ram_pos", causality=Fmi2Causality.output))
        self.register_variable(Real("ram_vel", causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        if abs(step_size - CYCLE) > 1e-9:
            self.log(f"step of {step_size} s refused, only {CYCLE} s", Fmi2Status.discard)
            return False
        h = CYCLE / 20
        for _ in range(20):
            force = self.ram_force - RETURN_SPRING * self.ram_pos - DAMPING * self.ram_vel
            self.ram_vel += h * force / MASS
            self.ram_pos += h * self.ram_vel
        return True

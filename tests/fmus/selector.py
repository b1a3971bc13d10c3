"""A gear selector: Integer, Boolean and String inputs and outputs of FMI 2.0."""

from pythonfmu import Boolean, Fmi2Causality, Fmi2Slave, Integer, Real, String


class Selector(Fmi2Slave):
    """Shows in the next step what it was given, and counts steps."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.gear, self.engaged, self.label = 1, False, ""
        self.gear_shown, self.engaged_shown, self.label_shown = 1, False, ""
        self.steps, self.torque = 0, 0.0
        into, out = Fmi2Causality.input, Fmi2Causality.output
        self.register_variable(Integer("gear", causality=into))
        self.register_variable(Boolean("engaged", causality=into))
        self.register_variable(String("label", causality=into))
        self.register_variable(Integer("gear_shown", causality=out))
        self.register_variable(Boolean("engaged_shown", causality=out))
        self.register_variable(String("label_shown", causality=out))
        self.register_variable(Integer("steps", causality=out))
        self.register_variable(Real("torque", causality=out))

    def do_step(self, current_time, step_size):
        self.gear_shown, self.engaged_shown, self.label_shown = self.gear, self.engaged, self.label
        self.steps += 1
        self.torque = 10.0 * self.gear if self.engaged else 0.0
        return True

"""Engine mount: linear spring and damper in parallel. The force acts on the upper side."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

STIFFNESS, DAMPING = 3.0e5, 900.0  # N/m, N.s/m


class EngineMount(Fmi2Slave):
    description = "spring and damper in parallel"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        for name in ("s_top", "s_bottom", "v_top", "v_bottom"):
            setattr(self, name, 0.0)
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        self.register_variable(Real("force", causality=Fmi2Causality.output, getter=self._force))

    def _force(self):
        stretch = self.s_top - self.s_bottom
        return -STIFFNESS * stretch - DAMPING * (self.v_top - self.v_bottom)

    def do_step(self, current_time, step_size):
        return True

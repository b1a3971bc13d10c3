"""Torsion bar without mass or damping between two flanges; the torques act on the neighbours."""

from types import SimpleNamespace

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

STIFFNESS = 2.5e4  # N.m/rad


class TorsionSpring(Fmi2Slave):
    description = "torsion bar, massless"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.flange_a = SimpleNamespace(phi=0.0)
        self.flange_b = SimpleNamespace(phi=0.0)
        for flange in ("flange_a", "flange_b"):
            self.register_variable(Real(f"{flange}.phi", causality=Fmi2Causality.input))
        self.register_variable(
            Real("flange_a.tau", causality=Fmi2Causality.output, getter=lambda: -self._torque())
        )
        self.register_variable(
            Real("flange_b.tau", causality=Fmi2Causality.output, getter=self._torque)
        )

    def _torque(self):
        return STIFFNESS * (self.flange_a.phi - self.flange_b.phi)

    def do_step(self, current_time, step_size):
        return True

"""Flywheel with windage from a library with one licence per process: while one instance lives, a
second is refused."""

from gc import collect
from weakref import WeakSet

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

INERTIA, WINDAGE = 1.8, 4e-4  # kg.m2, N.m.s2/rad2
LICENCES = WeakSet()


class SingleFlywheel(Fmi2Slave):
    description = "flywheel, one instance per process"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        if len(LICENCES) > 0:
            collect()  # instances that were freed but not yet cleared away
        if len(LICENCES) > 0:
            raise RuntimeError("SingleFlywheel: the only licence of this process is in use")
        LICENCES.add(self)
        self.tau_shaft = 0.0
        self.omega = 0.0
        self.angle = 0.0
        self.register_variable(Real("tau_shaft", causality=Fmi2Causality.input))
        self.register_variable(Real("omega", causality=Fmi2Causality.output))
        self.register_variable(Real("angle", causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        h = step_size / 10
        for _ in range(10):
            drag = WINDAGE * self.omega * abs(self.omega)
            self.omega += h * (self.tau_shaft - drag) / INERTIA
            self.angle += h * self.omega
        return True

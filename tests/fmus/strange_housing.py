"""A housing by a stranger: twelve independent oscillators, stock pythonfmu, no units."""

from itertools import product

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

SEATS = ("pinion_left", "pinion_right", "wheel_left", "wheel_right")
MASS, STIFFNESS, DAMPING = 50.0, 1e9, 1e4


class Seat:
    def __init__(self):
        for axis in "xyz":
            for name in ("f", "s", "v"):
                setattr(self, f"{name}_{axis}", 0.0)


class StrangeHousing(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        for seat, axis in product(SEATS, "xyz"):
            if not hasattr(self, seat):
                setattr(self, seat, Seat())
            self.register_variable(
                Real(f"{seat}.f_{axis}", causality=Fmi2Causality.input, start=0.0)
            )
            for name in ("s", "v"):
                self.register_variable(
                    Real(f"{seat}.{name}_{axis}", causality=Fmi2Causality.output)
                )

    def do_step(self, current_time, step_size):
        """Semi-implicit Euler; stable below 2 sqrt(m / k) = 0.4 ms."""
        for seat, axis in product(SEATS, "xyz"):
            at = getattr(self, seat)
            f, s, v = (getattr(at, f"{name}_{axis}") for name in "fsv")
            v += step_size * (f - STIFFNESS * s - DAMPING * v) / MASS
            setattr(at, f"v_{axis}", v)
            setattr(at, f"s_{axis}", s + step_size * v)
        return True

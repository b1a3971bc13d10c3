"""A stranger's housing with a residual compliance: its seats give way directly under force."""

from itertools import product

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

SEATS = ("pinion_left", "pinion_right", "wheel_left", "wheel_right")
MASS, STIFFNESS, DAMPING = 50.0, 1e9, 1e4
RESIDUAL = 0.0


class Seat:
    """One oscillator and the residual in series; `s` is the oscillator's position."""

    f = s = v = 0.0

    @property
    def position(self):
        return self.s + RESIDUAL * self.f

    def step(self, h):
        self.v += h * (self.f - STIFFNESS * self.s - DAMPING * self.v) / MASS
        self.s += h * self.v


class ResidualHousing(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.seats = {}
        for name, axis in product(SEATS, "xyz"):
            seat = self.seats[name, axis] = Seat()
            self.register_variable(
                Real(
                    f"{name}.f_{axis}",
                    causality=Fmi2Causality.input,
                    start=0.0,
                    getter=lambda seat=seat: seat.f,
                    setter=lambda value, seat=seat: setattr(seat, "f", value),
                )
            )
            for quantity, attribute in (("s", "position"), ("v", "v")):
                self.register_variable(
                    Real(
                        f"{name}.{quantity}_{axis}",
                        causality=Fmi2Causality.output,
                        getter=lambda seat=seat, attribute=attribute: getattr(seat, attribute),
                    )
                )

    def do_step(self, current_time, step_size):
        for seat in self.seats.values():
            seat.step(step_size)
        return True

"""Dual-mass flywheel behind a gearbox: engine side and gearbox side are inertias with an arc spring
between them, the gearbox side drives its flange through a stub shaft. Runge-Kutta inside; angle and
speed of the flange are held during a step. `flange.tau` acts on what is driven. No units, as
pythonfmu cannot write them."""

from types import SimpleNamespace

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

LONGEST = 1e-5  # s
PARAMETERS = {"engine_inertia": 0.12, "gearbox_inertia": 0.03, "arc_stiffness": 900.0,
              "arc_damping": 4.0, "stub_stiffness": 5e4, "stub_damping": 8.0}  # fmt: skip
FREE = 0.18  # rad, of the arc spring, before it meets its stop
STOP = 6e4  # N.m/rad
PARAMETER, FIXED = Fmi2Causality.parameter, Fmi2Variability.fixed


class DualMassFlywheel(Fmi2Slave):
    description = "dual-mass flywheel with stub shaft"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.flange = SimpleNamespace(phi=0.0, w=0.0)
        self.engine_torque = 0.0
        self.x = [0.0, 0.0, 0.0, 0.0]  # angles, then speeds, of engine side and gearbox side
        for name, value in PARAMETERS.items():
            setattr(self, name, value)
            self.register_variable(Real(name, causality=PARAMETER, variability=FIXED))
        for name in ("engine_torque", "flange.phi", "flange.w"):
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        self.register_variable(
            Real("flange.tau", causality=Fmi2Causality.output, getter=lambda: self._stub(self.x))
        )

    def _stub(self, x):
        turned = self.stub_stiffness * (x[1] - self.flange.phi)
        return turned + self.stub_damping * (x[3] - self.flange.w)

    def _arc(self, x):
        twist = x[0] - x[1]
        beyond = max(twist - FREE, 0.0) + min(twist + FREE, 0.0)
        return self.arc_stiffness * twist + STOP * beyond + self.arc_damping * (x[2] - x[3])

    def _rates(self, x):
        arc = self._arc(x)
        engine = (self.engine_torque - arc) / self.engine_inertia
        return [x[2], x[3], engine, (arc - self._stub(x)) / self.gearbox_inertia]

    def do_step(self, current_time, step_size):
        count = max(1, round(step_size / LONGEST))
        h = step_size / count
        for _ in range(count):
            x = self.x
            a = self._rates(x)
            b = self._rates([p + h / 2 * q for p, q in zip(x, a, strict=True)])
            c = self._rates([p + h / 2 * q for p, q in zip(x, b, strict=True)])
            d = self._rates([p + h * q for p, q in zip(x, c, strict=True)])
            self.x = [
                p + h / 6 * (i + 2 * j + 2 * k + m)
                for p, i, j, k, m in zip(x, a, b, c, d, strict=True)
            ]
        return True

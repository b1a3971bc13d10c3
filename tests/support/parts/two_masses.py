"""The linear test problem: two free masses, a spring-damper between them, and what goes wrong.

`Mass` is propagated exactly for any polynomial force; `SpringDamper` is massless; `TwoMass.exact`
is the solution of the whole.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import expm
from support.parts.fakes import OK, CallbackPart

from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.rows.record import Grid
from herringbone.cosim.rows.recording import Recording
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.system import PartSpec, System


class Mass(CallbackPart):
    """A free mass: s' = v, m v' = f, solved exactly for a polynomial force.

    f is the sum of `flange.f` and `load.f`.

    Args:
        name: instance name.
        mass: [kg].
        position, velocity: at the start [m, m/s].
        acceleration: `flange.a` is an output, too.
        misbehave: called with (part, t) after every step; may spoil it and return a status.
        more: options of `CallbackPart`.
    """

    def __init__(
        self, name, mass, position=0.0, velocity=0.0, *, acceleration=False, misbehave=None, **more
    ):
        outputs = ["flange.s", "flange.v", *(["flange.a"] if acceleration else [])]
        super().__init__(name, ["flange.f", "load.f"], outputs, **more)
        self.mass, self.misbehave = mass, misbehave
        self["flange.s"], self["flange.v"] = position, velocity

    def out(self):
        if "flange.a" in self.variables:
            self["flange.a"] = (self["flange.f"] + self["load.f"]) / self.mass

    def step(self, t, h):
        force = np.add(self.nodal("flange.f"), self.nodal("load.f"))
        count = len(force)
        a = np.linalg.solve(np.vander(np.arange(count) / max(count - 1, 1), increasing=True), force)
        j = np.arange(count)
        s, v = self["flange.s"], self["flange.v"]
        c = np.arange(1, max(count, 2))[:, None] / max(count - 1, 1)
        once, twice = c ** (j + 1) / (j + 1), c ** (j + 2) / ((j + 1) * (j + 2))
        self.write("flange.s", s + h * v * c[:, 0] + h * h / self.mass * (twice @ a))
        self.write("flange.v", v + h / self.mass * (once @ a))
        if "flange.a" in self.variables:
            self.write("flange.a", force[min(1, count - 1) :] / self.mass)
        return self.misbehave(self, t + h) or OK if self.misbehave else OK


class ResidualMass(Mass):
    """A mass whose flange also gives way directly under its force: s = position + compliance f.

    Args:
        compliance: [m/N]; the velocity knows nothing of it, as in MacNeal's residual.
        declared: the dependence of the position on the force is declared; if not, no output's is.
    """

    def __init__(self, *arguments, compliance, declared=True, **more):
        super().__init__(*arguments, **more)
        self.compliance = compliance
        self._add("position", "local")
        self["position"] = self["flange.s"]
        for name, v in self.variables.items():
            if v.causality == "output":
                direct = frozenset({"flange.f"} if name.startswith("flange.s") else ())
                self.variables[name] = replace(v, dependencies=direct if declared else None)

    def out(self):
        self["flange.s"] = self["position"] + self.compliance * self["flange.f"]

    def step(self, t, h):
        self["flange.s"] = self["position"]
        status = super().step(t, h)
        names = [f"flange.s.node{i}" for i in range(1, self.degree + 1)] or ["flange.s"]
        self["position"] = self["flange.s"]
        force = self.nodal("flange.f")[min(1, self.degree) :]
        moved = [self[name] + self.compliance * f for name, f in zip(names, force, strict=True)]
        self.write("flange.s", moved)
        return status


class Forgetful(Mass):
    """A mass that comes back from every restore a little further: its answer changes.

    Args:
        offset: by which each restore shifts it [m].
        after: restores that do not.
    """

    def __init__(self, *arguments, offset=1e-3, after=0, **more):
        super().__init__(*arguments, **more)
        self.offset, self.after = offset, after

    def restored(self):
        self["flange.s"] += self.offset * max(0, self.restores - self.after)


class Ramp(CallbackPart):
    """A source: the force b t, whose time is its own state."""

    def __init__(self, name, rate, **more):
        super().__init__(name, [], ["flange.f"], **more)
        self.rate = rate
        self._add("time", "local")

    def step(self, t, h):
        before = self["time"]
        self["time"] += h
        count = max(self.degree, 1)
        self.write("flange.f", [self.rate * (before + h * i / count) for i in range(1, count + 1)])
        return OK


class Echo(CallbackPart):
    """A body whose position is the negative force: with a spring of 1 N/m, G(U) = U."""

    def __init__(self, name):
        super().__init__(name, ["flange.f"], ["flange.s", "flange.v"])

    def step(self, t, h):
        force = self.nodal("flange.f")
        self.write("flange.s", [-f for f in force[min(1, self.degree) :]])
        return OK


class SpringDamper(CallbackPart):
    """Massless spring-damper between flanges a and b; forces act on the bodies.

    The stiffness is a number or a function of time.
    """

    feedthrough = True

    def __init__(self, name, stiffness, damping, **more):
        motion = [f"{side}.{q}" for side in "ab" for q in "sv"]
        super().__init__(name, motion, ["a.f", "b.f"], **more)
        self.stiffness = stiffness if callable(stiffness) else lambda t: stiffness
        self.damping = damping

    def _write(self, motions, times):
        a_s, a_v, b_s, b_v = (np.asarray(motion) for motion in motions)
        k = np.array([self.stiffness(t) for t in times])
        force = k * (a_s - b_s) + self.damping * (a_v - b_v)
        self.write("b.f", force)
        self.write("a.f", -force)

    def out(self):
        self._write([[self[name]] for name in self.inputs], [0.0])

    def step(self, t, h):
        degree = self.degree
        motions = [self.nodal(name)[min(degree, 1) :] for name in self.inputs]
        self._write(motions, [t + h * i / max(degree, 1) for i in range(1, max(degree, 1) + 1)])
        return OK


@dataclass(frozen=True)
class TwoMass:
    """Two free masses and a spring-damper of frequency w [rad/s] and damping ratio zeta.

    The start is at rest with the spring stretched, so that the force has no rate at first and a
    start without history costs nothing.
    """

    w: float = 1.0
    zeta: float = 0.0
    mass: tuple[float, float] = (1.0, 3.0)
    start: tuple[float, float] = (1.0, -0.2)

    @property
    def reduced(self):
        """Reduced mass [kg]."""
        return self.mass[0] * self.mass[1] / sum(self.mass)

    @property
    def stiffness(self):
        """Of the spring [N/m]."""
        return self.reduced * self.w**2

    @property
    def damping(self):
        """Of the damper [N s/m]."""
        return 2.0 * self.zeta * self.reduced * self.w

    def parts(
        self, *, nodes=True, acceleration=False, states=True, kind=Mass, stiffness=None, **more
    ):
        """New participants.

        Args:
            nodes, acceleration: of both masses.
            states: all parts can be restored.
            kind: class of the left mass; `more` are options of it.
            stiffness: of the spring, instead of the problem's.
        """
        both = {"nodes": nodes, "acceleration": acceleration, "state": states}
        return [
            kind("left", self.mass[0], self.start[0], **(both | more)),
            Mass("right", self.mass[1], self.start[1], **both),
            SpringDamper("spring", stiffness or self.stiffness, self.damping, state=states),
        ]

    def exact(self, times):
        """Positions and velocities (n, 4): s, v of the left, s, v of the right mass."""
        (m1, m2), k, c = self.mass, self.stiffness, self.damping
        a = np.array(
            [
                [0.0, 1.0, 0.0, 0.0],
                [-k / m1, -c / m1, k / m1, c / m1],
                [0.0, 0.0, 0.0, 1.0],
                [k / m2, c / m2, -k / m2, -c / m2],
            ]
        )
        x0 = np.array([self.start[0], 0.0, self.start[1], 0.0])
        return np.array([expm(a * t) @ x0 for t in times])

    def run(self, algorithm: Algorithm, h: float, t_end: float, **more) -> Recording:
        """Run with new participants, recording every step."""
        grid = every_step(algorithm, h, t_end)
        return simulate(TWO_MASS_SYSTEM, self.parts(**more), algorithm, grid)


def every_step(algorithm: Algorithm, h: float, t_end: float) -> Grid:
    """Records where steps end, if these follow a tolerance too."""
    grid = make_grid(t_end, h, h)
    return grid._replace(every=0) if algorithm.adaptive else grid


TWO_MASS_SYSTEM = System(
    "two_mass",
    "",
    tuple(PartSpec(name) for name in ("left", "right", "spring")),
    (("left.flange", "spring.a"), ("right.flange", "spring.b")),
)
MOTION = ("left.flange.s", "left.flange.v", "right.flange.s", "right.flange.v")

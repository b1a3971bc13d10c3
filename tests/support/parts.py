"""Participants for tests, in plain Python behind C addresses: the algorithms know no component.

`Mass` is a free body, propagated exactly for any polynomial force; `SpringDamper` is massless. Two
masses and a spring-damper are the linear test problem, whose solution `two_mass_exact` gives.
"""

import ctypes
import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from scipy.linalg import expm

from herringbone.components.in_process import InProcessPart
from herringbone.components.registry import component
from herringbone.core import Instance, ParameterError
from herringbone.core.part import Addresses, PartVariable, closing_all
from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.fmu.opening import open_fmu
from herringbone.cosim.rows.record import Grid
from herringbone.cosim.rows.recording import Recording
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.system import PartSpec, System

OK, DISCARD, ERROR = 0, 2, 3
NODES = 4
DEGREE = "interface_degree"

_REALS = ctypes.POINTER(ctypes.c_double)
_REFERENCES = ctypes.POINTER(ctypes.c_uint32)
_EXCHANGE = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, _REFERENCES, ctypes.c_size_t, _REALS)
_DO_STEP = ctypes.CFUNCTYPE(
    ctypes.c_int32, ctypes.c_void_p, ctypes.c_double, ctypes.c_double, ctypes.c_int32
)

_HANDLE = ctypes.POINTER(ctypes.c_int64)
_SAVE = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, _HANDLE)
_RESTORE = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, ctypes.c_int64)

UNIT = {"s": "m", "v": "m/s", "a": "m/s2", "f": "N"}


@dataclass
class FakePart:
    """Only a name and variables, for tests of structure."""

    name: str
    variables: dict[str, PartVariable] = field(default_factory=dict)
    has_states: bool | None = None
    once: bool = False
    one_step: bool = False

    def real(self, name, causality, unit="1", dependencies=None, **more):
        """Add a variable; outputs depend on nothing unless told."""
        if causality == "output" and dependencies is None:
            dependencies = frozenset()
        self.variables[name] = PartVariable(
            name, len(self.variables), causality, unit,
            dependencies=dependencies, **more,
        )  # fmt: skip
        return self


class CallbackPart:
    """A participant whose FMI functions are Python functions on the list `memory`.

    Args:
        name: instance name.
        inputs, outputs: names; outputs depend directly on the inputs if `feedthrough`.
        nodes: inputs and outputs are polynomial signals.
        state: the state can be saved and restored.
        start: start values by name.

    Attributes:
        steps: calls of doStep.
        restores: calls of fmi2SetFMUstate.
        saved: states that were saved and not freed, by handle.
    """

    feedthrough = False
    has_states = None
    once = one_step = False

    def __init__(self, name, inputs, outputs, *, nodes=True, state=True, start=None):
        self.name, self.inputs, self.outputs = name, tuple(inputs), tuple(outputs)
        self.variables: dict[str, PartVariable] = {}
        self.memory: list[float] = []
        for output in self.outputs:
            dependencies = frozenset(self.inputs if self.feedthrough else ())
            self._add(output, "output", dependencies)
            for node in range(1, NODES + 1) if nodes else ():
                self._add(f"{output}.node{node}", "output", dependencies)
        for input_ in self.inputs:
            self._add(input_, "input")
            for node in range(1, NODES + 1) if nodes else ():
                self._add(f"{input_}.node{node}", "input")
        if nodes:
            self._add(DEGREE, "parameter")
        for key, value in (start or {}).items():
            self.set(key, value)
        self.steps = self.restores = 0
        self.saved: dict[int, list[float]] = {}
        self.closed = False
        self._functions = [
            _EXCHANGE(self._set_real), _EXCHANGE(self._get_real), _DO_STEP(self._do_step)
        ]  # fmt: skip
        if state:
            self._functions += [_SAVE(self._save), _RESTORE(self._restore), _SAVE(self._free)]

    def _add(self, name, causality, dependencies=None):
        unit = UNIT.get(name.split(".")[1]) if "." in name else "1"
        self.variables[name] = PartVariable(
            name, len(self.memory), causality, unit, dependencies=dependencies
        )
        self.memory.append(0.0)

    def __getitem__(self, name):
        return self.memory[self.variables[name].reference]

    def __setitem__(self, name, value):
        self.memory[self.variables[name].reference] = value

    @property
    def degree(self):
        """Interface degree, 0 without nodes."""
        return int(self[DEGREE]) if DEGREE in self.variables else 0

    def nodal(self, name):
        """Values of an input at the live nodes of the macro step."""
        return [self[name], *(self[f"{name}.node{i}"] for i in range(1, self.degree + 1))]

    def write(self, name, values):
        """Write an output at nodes 1 ... p; the last value is that at the end."""
        for i, value in enumerate(values[: self.degree], 1):
            self[f"{name}.node{i}"] = value
        self[name] = values[-1]

    # -- what a compiled loop calls -------------------------------------------------------------
    def _set_real(self, _component, references, count, values):
        for i in range(count):
            self.memory[references[i]] = values[i]
        return OK

    def _get_real(self, _component, references, count, values):
        for i in range(count):
            values[i] = self.memory[references[i]]
        return OK

    def _do_step(self, _component, t, h, _no_rollback):
        self.steps += 1
        return self.step(t, h)

    def _save(self, _component, handle):
        if handle[0] in self.saved:
            return ERROR  # overwritten before it was freed
        handle[0] = max(self.saved, default=0) + 1
        self.saved[handle[0]] = list(self.memory)
        return OK

    def _restore(self, _component, handle):
        self.restores += 1
        self.memory[:] = self.saved[handle]
        return self.restored() or OK

    def _free(self, _component, handle):
        del self.saved[handle[0]]
        handle[0] = 0
        return OK

    def restored(self):
        """Called after every restore; may spoil it and return a status."""

    def step(self, t, h):
        """Advance, write the outputs; FMI status."""
        raise NotImplementedError

    def out(self):
        """Write the outputs of the start."""

    # -- the Part protocol ----------------------------------------------------------------------
    @property
    def addresses(self):
        """Addresses of the callbacks; they ignore the component pointer."""
        return Addresses(1, *(ctypes.cast(f, ctypes.c_void_p).value for f in self._functions))

    def new_state(self):
        """0: the part keeps its states."""
        return 0

    def set(self, name, value):
        """Set a variable."""
        if name not in self.variables:
            raise ParameterError(f"{self.name} has no variable '{name}'")
        self[name] = float(value)

    def get(self, names):
        """Values; in initialisation they belong to the inputs just set."""
        if self.steps == 0:
            self.out()
        return [self[name] for name in names]

    def enter_initialization(self, start_time, stop_time, tolerance=None):
        """Compute the outputs of the start."""
        self.out()

    def exit_initialization(self):
        """Compute the outputs of the start."""
        self.out()

    def ended(self):
        """It never asks to end the simulation."""
        return None

    def failed(self):
        """Nothing follows from it."""

    def messages(self):
        """Nothing is logged."""
        return []

    def close(self):
        """Remember that it was called."""
        self.closed = True


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
        return simulate(TWO_MASS_SYSTEM, self.parts(**more), algorithm, make_grid(t_end, h, h))


TWO_MASS_SYSTEM = System(
    "two_mass",
    "",
    tuple(PartSpec(name) for name in ("left", "right", "spring")),
    (("left.flange", "spring.a"), ("right.flange", "spring.b")),
)
MOTION = ("left.flange.s", "left.flange.v", "right.flange.s", "right.flange.v")


def columns(recording: Recording, names: Sequence[str]) -> np.ndarray:
    """Recorded values (n, len(names))."""
    return recording.values[:, [recording.names.index(name) for name in names]]


def slope(steps: Sequence[float], errors: Sequence[float]) -> float:
    """Least-squares slope of log error over log step."""
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])


def open_in_process(system: System) -> list[InProcessPart]:
    """All parts of a system of components, in-process, values set."""
    parts = []
    for spec in system.parts:
        part = InProcessPart(Instance(component(spec.component), spec.name))
        for name, value in spec.values.items():
            part.set(name, value)
        parts.append(part)
    return parts


def run_fmus_and_in_process(
    system: System, fmus: Mapping[str, Path], algorithm: Algorithm, grid: Grid, **more
) -> tuple[Recording, Recording]:
    """Run a system of components as FMUs and in-process.

    Args:
        fmus: file of each component's FMU.
        more: further arguments of `simulate`.
    """
    parts = [open_fmu(spec.name, fmus[spec.component]) for spec in system.parts]
    with closing_all(parts):
        for part, spec in zip(parts, system.parts, strict=True):
            for name, value in spec.values.items():
                part.set(name, value)
        both = (parts, open_in_process(system))
        found, wanted = (simulate(system, each, algorithm, grid, **more) for each in both)
    return found, wanted


def run_in_process(system: System, algorithm: Algorithm, h: float, t_end: float, record=None):
    """Run a system of components in-process."""
    return simulate(system, open_in_process(system), algorithm, make_grid(t_end, h, record or h))


def fail_at(when, status=ERROR):
    """Misbehaviour: refuse the step that ends at `when`."""
    return lambda part, t: status if t > when - 1e-9 else OK


def spoil_at(when, value=math.nan):
    """Misbehaviour: a velocity that is not finite from `when` on."""

    def spoil(part, t):
        if t > when - 1e-9:
            part["flange.v"] = value
        return OK

    return spoil


def dawdle(seconds):
    """Misbehaviour: sleep in every step."""

    def sleep(part, t):
        time.sleep(seconds)
        return OK

    return sleep


PROTOTYPE_HOUSING = {
    f"modal_housing.{name}": str(Path(__file__).parents[1] / "data" / "prototype_housing" / file)
    for name, file in (("modes", "modes.csv"), ("shapes", "shapes.csv"))
}
"""Housing of the dense prototypes whose figures some tests reproduce: 52 oscillators."""

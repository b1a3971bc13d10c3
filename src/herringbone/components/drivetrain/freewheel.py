"""Freewheel: flange a drives flange b through a spring, and b may overrun a.

    z = phi_a - phi_b - free_angle,   w_rel = w_a - w_b
    free_angle' = min(0, z) / release_time,   so that z' = w_rel - min(0, z) / release_time
    torque = max(0, stiffness z + damping r w_rel) where z > 0, else 0
    r = v^2 (3 - 2 v),   v = min(1, z / engagement_angle)
    tau_a = -torque,   tau_b = +torque

z is the twist of the sprags. While a drives (z > 0), free_angle is constant and this is a shaft
coupling. When b overruns, z goes below 0 and free_angle follows, release_time behind: z becomes
w_rel release_time. So the freewheel engages again wherever b stops to overrun, and no torque acts
meanwhile. Damping rises smoothly with the engagement and never pulls.

A start in equilibrium is engaged where there is such one. Else it is overrun, free_angle grows, and
each side turns at the speed at which its own torques balance; where they do not, start the run from
declared values, or engaged, with a start offset of the speeds.

Left out: drag while overrunning, the inertia of the sprags, slip at overload.

Sources: Modelica.Mechanics.Rotational.Components.OneWayClutch (names and signs), with an elastic
engagement in place of its discrete one.
"""

import numpy as np

from herringbone.components.ports import MOTION, coupled_flanges, flange
from herringbone.core import Component, Declaration, Kernels, Laws, output, parameter, state
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.kernels import steppers
from herringbone.kernels.compiling.jit import kernel

_ENGAGED = 1e-3
"""A usual twist [rad], where the search for an equilibrium begins."""

_d = Declaration(
    "freewheel",
    "Shaft coupling that one side may overrun",
    [
        state("free_angle", "rad", "by which a is ahead of b where the sprags engage"),
        *coupled_flanges(),
        output("torque", "N.m", "torque handed from a to b", feedthrough=MOTION,
               quantity=Quantity.TORQUE),
        output("twist", "rad", "of the sprags, z; below 0: b overruns",
               feedthrough=("flange_a.phi", "flange_b.phi")),
        output("w_rel", "rad/s", "speed of a over b", feedthrough=("flange_a.w", "flange_b.w")),
        output("twist_rate", "rad/s", "rate of the twist, z'", feedthrough=MOTION, steady="zero"),
        parameter("stiffness", "N.m/rad", "torsional, engaged", 6e4, minimum=0,
                  quantity=Quantity.STIFFNESS),
        parameter("damping", "N.m.s/rad", "torsional, engaged", 5.0, minimum=0,
                  quantity=Quantity.DAMPING),
        parameter("engagement_angle", "rad", "twist at which damping is full", 1e-4, minimum=1e-9),
        parameter("release_time", "s", "until the free angle follows", 1e-3, minimum=1e-4),
        parameter("micro_step", "s", "longest Runge-Kutta step", 5e-5, minimum=1e-9, maximum=1e-4,
                  quantity=Quantity.MICRO_STEP),
    ],
    work=steppers.body_work(1, len(MOTION)),
    roles=[Role.COUPLING],
    ports=[flange("flange_a"), flange("flange_b")],
)  # fmt: skip

_FREE = _d.index["free_angle"]
_PHI_A, _W_A, _PHI_B, _W_B = _d.indices(*MOTION)
_TAU_A, _TAU_B, _TORQUE, _TWIST, _W_REL, _RATE = _d.indices(
    "flange_a.tau", "flange_b.tau", "torque", "twist", "w_rel", "twist_rate"
)
_STIFFNESS, _DAMPING, _ENGAGEMENT, _RELEASE, _MICRO_STEP, _DEGREE = _d.indices(
    "stiffness", "damping", "engagement_angle", "release_time", "micro_step", "interface_degree"
)


@kernel
def _twist(b: np.ndarray) -> float:
    return b[_PHI_A] - b[_PHI_B] - b[_FREE]


@kernel
def _overrun(b: np.ndarray, twist: float) -> float:
    """Rate of the free angle [rad/s]."""
    return min(0.0, twist) / b[_RELEASE]


@kernel
def _rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    dx[_FREE] = _overrun(b, _twist(b))


@kernel
def _damping(b: np.ndarray, twist: float) -> float:
    v = min(1.0, twist / b[_ENGAGEMENT])
    return b[_DAMPING] * v * v * (3.0 - 2.0 * v)


@kernel
def _torque(b: np.ndarray, twist: float, speed: float) -> float:
    if twist <= 0.0:
        return 0.0
    return max(0.0, b[_STIFFNESS] * twist + _damping(b, twist) * speed)


@kernel
def _write(b: np.ndarray, twist: float, speed: float, torque: float) -> None:
    b[_TWIST], b[_W_REL], b[_TORQUE] = twist, speed, torque
    b[_TAU_A], b[_TAU_B] = -torque, torque


@kernel
def _out(b: np.ndarray, t: float) -> None:
    twist, speed = _twist(b), b[_W_A] - b[_W_B]
    _write(b, twist, speed, _torque(b, twist, speed))
    b[_RATE] = speed - _overrun(b, twist)


_advance = steppers.body_stepper(_rhs, _out, _d)


@kernel
def _step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    return _advance(b, w, t, h, b[_MICRO_STEP], int(b[_DEGREE]))


def _guess(block: np.ndarray) -> None:
    """Engaged: where the sprags are open, nothing depends on the twist."""
    block[_FREE] = block[_PHI_A] - block[_PHI_B] - _ENGAGED


@kernel
def _gather(b: np.ndarray, z: np.ndarray) -> None:
    z[0], z[1] = _twist(b), b[_W_A] - b[_W_B]


@kernel
def _evaluate(b: np.ndarray, z: np.ndarray, f: np.ndarray, k: np.ndarray, e: np.ndarray) -> None:
    twist, speed = z[0], z[1]
    f[0] = _torque(b, twist, speed)
    f[1] = _overrun(b, twist)
    carries = f[0] > 0.0
    k[0] = b[_STIFFNESS] if carries else 0.0
    k[1] = _damping(b, twist) if carries else 0.0
    k[2] = 1.0 if twist < 0.0 else 0.0
    e[0] = 1.0 if carries else -1.0
    e[1], e[2] = twist - b[_ENGAGEMENT], twist


@kernel
def _apply(b: np.ndarray, t: float, f: np.ndarray, dx: np.ndarray) -> None:
    twist, speed = _twist(b), b[_W_A] - b[_W_B]
    _write(b, twist, speed, f[0])
    dx[_FREE] = f[1]
    b[_RATE] = speed - f[1]


def _directions(block: np.ndarray) -> np.ndarray:
    return np.array([[1.0, 0.0], [0.0, 1.0], [1.0 / block[_RELEASE], 0.0]])


def _engaged(block: np.ndarray) -> np.ndarray:
    """Tangents while a drives."""
    return np.array([block[_STIFFNESS], block[_DAMPING], 0.0])


_LAWS = Laws(
    arguments=("twist of the sprags", "speed of a over b"),
    values=("torque", "rate of the free angle"),
    stiff=(0, 0, 1),
    kinks=3,
    gather=_gather,
    evaluate=_evaluate,
    apply=_apply,
    directions=_directions,
    mean=_engaged,
)

FREEWHEEL = Component(
    _d,
    Kernels(_step, _rhs, _out),
    __doc__,
    guess=_guess,
    laws=_LAWS,
    longest_step=steppers.longest_step(_d, "micro_step"),
)

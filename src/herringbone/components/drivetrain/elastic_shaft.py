"""Elastic shaft with its own inertia: rotation and torsional modes of a uniform, free shaft.

    phi_a = angle + sum of q_k,   phi_b = angle + sum of (-1)^k q_k,   k = 1 ... number_of_modes
    J w' = tau_a + tau_b,   angle' = w
    m_k (q_k'' + 2 damping_ratio W_k q_k' + W_k^2 q_k) = tau_a + (-1)^k tau_b
    W_k = k pi sqrt(stiffness / J),   m_k = J / 2

J is the whole inertia, `stiffness` the static torsional stiffness G I_p / l from end to end. Modes
1 ... number_of_modes have their exact frequencies. The two highest ones, one of each parity, also
stand for all above them: their m_k is lowered so that the twist under constant torques is exact,

    m_K = J / (2 K^2 (P - S)),   P = pi^2 / 8 (K odd) or pi^2 / 24 (K even)
    S: sum of 1 / k^2 over k = K - 2, K - 4, ... > 0

Motion in, torque out is what a shaft without inertia does; this one is a body: join it by shaft
couplings or by what has torques, such as a torque source.

Source: L. Meirovitch, Fundamentals of Vibrations (2001), section 8.6: shaft in torsion with free
ends, modes cos(k pi x / l).
"""

import math

import numpy as np

from herringbone.components.ports import flange, flange_body
from herringbone.core import Component, Declaration, Kernels, output, parameter, state
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.kernels import steppers
from herringbone.kernels.compiling.jit import kernel

MODES = 8
"""Room for modes."""
_SIZE = 1e-4
"""Nominal twist [rad] and, times 1e3 rad/s, its rate."""

_d = Declaration(
    "elastic_shaft",
    "Uniform elastic shaft with inertia and torsional modes",
    [
        state("angle", "rad", "angle of the rigid rotation", steady="rotating"),
        *(state(f"q_{k}", "rad", f"twist of mode {k} at flange a", nominal=_SIZE)
          for k in range(1, MODES + 1)),
        state("speed", "rad/s", "angular velocity of the rigid rotation", nominal=100.0),
        *(state(f"der(q_{k})", "rad/s", f"rate of q_{k}", nominal=1e3 * _SIZE)
          for k in range(1, MODES + 1)),
        *flange_body("flange_a", more=("flange_b.tau",)),
        *flange_body("flange_b", more=("flange_a.tau",)),
        output("phi_rel", "rad", "twist, phi_a - phi_b"),
        parameter("inertia", "kg.m2", "of the whole shaft", 1.0, minimum=1e-9,
                  quantity=Quantity.INERTIA),
        parameter("stiffness", "N.m/rad", "static, from end to end", 1e6, minimum=1e-6,
                  quantity=Quantity.STIFFNESS),
        parameter("damping_ratio", "1", "of each mode", 0.01, minimum=0, maximum=1),
        parameter("number_of_modes", "1", "modes that are used", 4.0, minimum=1, maximum=MODES,
                  whole=True),
        parameter("micro_step", "s", "longest Runge-Kutta step", 5e-5, minimum=1e-9, maximum=1e-4,
                  quantity=Quantity.MICRO_STEP),
    ],
    work=steppers.body_work(2 * MODES + 2, 2),
    roles=[Role.ROTOR],
    ports=[flange("flange_a"), flange("flange_b")],
)  # fmt: skip

_ANGLE, _SPEED, _Q, _RATE = _d.indices("angle", "speed", "q_1", "der(q_1)")
_TAU_A, _PHI_A, _W_A, _A_A = _d.indices(*(f"flange_a.{q}" for q in ("tau", "phi", "w", "a")))
_TAU_B, _PHI_B, _W_B, _A_B = _d.indices(*(f"flange_b.{q}" for q in ("tau", "phi", "w", "a")))
_PHI_REL, _INERTIA, _STIFFNESS, _DAMPING, _MODES, _MICRO_STEP, _DEGREE = _d.indices(
    "phi_rel", "inertia", "stiffness", "damping_ratio", "number_of_modes", "micro_step",
    "interface_degree",
)  # fmt: skip
_ODD, _EVEN = math.pi**2 / 8.0, math.pi**2 / 24.0
_RADIANS = 0.1
"""Of the highest mode in a Runge-Kutta step: its period errs by 1e-6."""


@kernel
def _frequency(b: np.ndarray, k: int) -> float:
    """Of mode k [rad/s]."""
    return k * math.pi * math.sqrt(b[_STIFFNESS] / b[_INERTIA])


@kernel
def _mass(b: np.ndarray, k: int) -> float:
    """Modal mass of mode k [kg m2]."""
    if k + 2 <= int(b[_MODES]):
        return 0.5 * b[_INERTIA]
    rest, below = _ODD if k % 2 == 1 else _EVEN, k - 2
    while below > 0:
        rest -= 1.0 / (below * below)
        below -= 2
    return 0.5 * b[_INERTIA] / (k * k * rest)


@kernel
def _acceleration(b: np.ndarray, k: int) -> float:
    """Of mode k [rad/s2]."""
    w = _frequency(b, k)
    torque = b[_TAU_A] - b[_TAU_B] if k % 2 == 1 else b[_TAU_A] + b[_TAU_B]
    inner = 2.0 * b[_DAMPING] * w * b[_RATE + k - 1] + w * w * b[_Q + k - 1]
    return torque / _mass(b, k) - inner


@kernel
def _rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    dx[_ANGLE] = b[_SPEED]
    dx[_SPEED] = (b[_TAU_A] + b[_TAU_B]) / b[_INERTIA]
    for i in range(MODES):
        dx[_Q + i], dx[_RATE + i] = 0.0, 0.0
    for k in range(1, int(b[_MODES]) + 1):
        dx[_Q + k - 1] = b[_RATE + k - 1]
        dx[_RATE + k - 1] = _acceleration(b, k)


@kernel
def _out(b: np.ndarray, t: float) -> None:
    rigid = (b[_TAU_A] + b[_TAU_B]) / b[_INERTIA]
    b[_PHI_A], b[_W_A], b[_A_A] = b[_ANGLE], b[_SPEED], rigid
    b[_PHI_B], b[_W_B], b[_A_B] = b[_ANGLE], b[_SPEED], rigid
    for k in range(1, int(b[_MODES]) + 1):
        sign = -1.0 if k % 2 == 1 else 1.0
        q, w, a = b[_Q + k - 1], b[_RATE + k - 1], _acceleration(b, k)
        b[_PHI_A] += q
        b[_W_A] += w
        b[_A_A] += a
        b[_PHI_B] += sign * q
        b[_W_B] += sign * w
        b[_A_B] += sign * a
    b[_PHI_REL] = b[_PHI_A] - b[_PHI_B]


_advance = steppers.body_stepper(_rhs, _out, _d)


@kernel
def _micro_step(b: np.ndarray) -> float:
    """Longest Runge-Kutta step [s]."""
    return min(b[_MICRO_STEP], _RADIANS / _frequency(b, int(b[_MODES])))


@kernel
def _step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    return _advance(b, w, t, h, _micro_step(b), int(b[_DEGREE]))


ELASTIC_SHAFT = Component(
    _d, Kernels(_step, _rhs, _out), __doc__, longest_step=steppers.longest_step_by(_d, _micro_step)
)

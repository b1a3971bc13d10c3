"""Inertia: a rigid body that turns, with flanges at both ends and one for a branch.

    J w' = tau_a + tau_b + tau_c,   phi' = w;   phi, w are those of all flanges

A flange that nothing is joined to has no torque. Flange c is for what does not lie in the line of
shafts: the motor of a mechanically closed loop, a brake, a torque source beside a coupling.

Source: Modelica.Mechanics.Rotational.Components.Inertia (names and signs; it has two flanges).
"""

import numpy as np

from herringbone.components.ports import flange, flange_body
from herringbone.core import Component, Declaration, Kernels, parameter, state
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.kernels import steppers
from herringbone.kernels.compiling.jit import kernel

FLANGES = ("flange_a", "flange_b", "flange_c")
_TORQUES = tuple(f"{port}.tau" for port in FLANGES)


def _port(port: str) -> tuple:
    """Variables of a flange, whose acceleration depends on the torques on all."""
    return flange_body(port, more=tuple(name for name in _TORQUES if name != f"{port}.tau"))


_d = Declaration(
    "rotating_inertia",
    "Rigid body that turns, with three flanges",
    [
        state("angle", "rad", "angle of rotation", steady="rotating"),
        state("speed", "rad/s", "angular velocity", nominal=100.0),
        *(variable for port in FLANGES for variable in _port(port)),
        parameter("inertia", "kg.m2", "moment of inertia", 1.0, minimum=1e-9,
                  quantity=Quantity.INERTIA),
        parameter("micro_step", "s", "longest Runge-Kutta step", 5e-5, minimum=1e-9, maximum=1e-4,
                  tunable=True, quantity=Quantity.MICRO_STEP),
    ],
    work=steppers.body_work(2, len(FLANGES)),
    roles=[Role.ROTOR],
    ports=[flange(port) for port in FLANGES],
)  # fmt: skip

_ANGLE, _SPEED, _INERTIA, _MICRO_STEP, _DEGREE = _d.indices(
    "angle", "speed", "inertia", "micro_step", "interface_degree"
)
_TAU_A, _TAU_B, _TAU_C = _d.indices(*_TORQUES)
_PHI_A, _PHI_B, _PHI_C = _d.indices(*(f"{port}.phi" for port in FLANGES))
_W_A, _W_B, _W_C = _d.indices(*(f"{port}.w" for port in FLANGES))
_A_A, _A_B, _A_C = _d.indices(*(f"{port}.a" for port in FLANGES))


@kernel
def _acceleration(b: np.ndarray) -> float:
    return (b[_TAU_A] + b[_TAU_B] + b[_TAU_C]) / b[_INERTIA]


@kernel
def _rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    dx[_ANGLE] = b[_SPEED]
    dx[_SPEED] = _acceleration(b)


@kernel
def _out(b: np.ndarray, t: float) -> None:
    a = _acceleration(b)
    b[_PHI_A], b[_W_A], b[_A_A] = b[_ANGLE], b[_SPEED], a
    b[_PHI_B], b[_W_B], b[_A_B] = b[_ANGLE], b[_SPEED], a
    b[_PHI_C], b[_W_C], b[_A_C] = b[_ANGLE], b[_SPEED], a


_advance = steppers.body_stepper(_rhs, _out, _d)


@kernel
def _step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    return _advance(b, w, t, h, b[_MICRO_STEP], int(b[_DEGREE]))


ROTATING_INERTIA = Component(
    _d,
    Kernels(_step, _rhs, _out),
    __doc__,
    longest_step=steppers.longest_step(_d, "micro_step"),
)

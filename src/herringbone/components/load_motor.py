"""Torque-controlled load motor: a generator that feeds its power back (closed power flow).

    J w' = tau - T - viscous_friction w,   phi' = w
    T' = (torque_setpoint - T) / torque_time_constant

T brakes rotation in driving direction. While T w > 0 the motor is a generator and feeds
`efficiency` of it back; while T w < 0 it drives, and takes more than it gives:

    recovered_power = efficiency T w   where T w > 0,   T w / efficiency   where T w < 0
    loss_power = T w - recovered_power + viscous_friction w^2

A Runge-Kutta step is never longer than 1 / (fastest own rate), of viscous_friction / J and
1 / torque_time_constant: a light rotor would run away in the steps of `micro_step`.

Source: the closed-power-flow rig of the thesis, chapter 5; data are choices of this project.
"""

import numpy as np

from herringbone.components.ports import flange, flange_body
from herringbone.core import Component, Declaration, Kernels, input_, output, parameter, state
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.kernels import steppers
from herringbone.kernels.compiling.jit import kernel

_d = Declaration(
    "load_motor",
    "Torque-controlled load motor that recovers its power",
    [
        state("angle", "rad", "rotor angle", steady="rotating"),
        state("speed", "rad/s", "rotor speed", nominal=100.0),
        state("braking_torque", "N.m", "air-gap torque against rotation", nominal=100.0),
        *flange_body("flange"),
        input_("torque_setpoint", "N.m", "braking torque set point",
               quantity=Quantity.TORQUE_SETPOINT),
        output("torque", "N.m", "air-gap torque against rotation", quantity=Quantity.TORQUE),
        output("recovered_power", "W", "power fed back to the supply",
               quantity=Quantity.RECOVERED_POWER),
        output("loss_power", "W", "generator and friction losses", quantity=Quantity.LOSS_POWER),
        parameter("inertia", "kg.m2", "rotor inertia", 2.0, minimum=1e-9,
                  quantity=Quantity.INERTIA),
        parameter("viscous_friction", "N.m.s/rad", "rotor friction", 0.0, minimum=0),
        parameter("torque_time_constant", "s", "of the torque control", 5e-3, minimum=1e-4),
        parameter("efficiency", "1", "mechanical to electrical", 0.93, minimum=0.01, maximum=1),
        parameter("micro_step", "s", "longest Runge-Kutta step", 5e-5, minimum=1e-9, maximum=1e-4,
                  tunable=True, quantity=Quantity.MICRO_STEP),
    ],
    work=steppers.body_work(3, 2),
    roles=[Role.LOAD],
    ports=[flange("flange")],
)  # fmt: skip

_ANGLE, _SPEED, _BRAKING = _d.indices("angle", "speed", "braking_torque")
_TAU, _SETPOINT, _PHI, _W, _A = _d.indices(
    "flange.tau", "torque_setpoint", "flange.phi", "flange.w", "flange.a"
)
_TORQUE, _RECOVERED, _LOSS = _d.indices("torque", "recovered_power", "loss_power")
_INERTIA, _FRICTION, _TIME_CONSTANT, _EFFICIENCY, _MICRO_STEP, _DEGREE = _d.indices(
    "inertia", "viscous_friction", "torque_time_constant", "efficiency", "micro_step",
    "interface_degree",
)  # fmt: skip


@kernel
def _rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    dx[_ANGLE] = b[_SPEED]
    dx[_SPEED] = (b[_TAU] - b[_BRAKING] - b[_FRICTION] * b[_SPEED]) / b[_INERTIA]
    dx[_BRAKING] = (b[_SETPOINT] - b[_BRAKING]) / b[_TIME_CONSTANT]


@kernel
def _out(b: np.ndarray, t: float) -> None:
    friction = b[_FRICTION] * b[_SPEED]
    b[_PHI], b[_W] = b[_ANGLE], b[_SPEED]
    b[_A] = (b[_TAU] - b[_BRAKING] - friction) / b[_INERTIA]
    b[_TORQUE] = b[_BRAKING]
    power = b[_BRAKING] * b[_SPEED]
    b[_RECOVERED] = power * b[_EFFICIENCY] if power > 0.0 else power / b[_EFFICIENCY]
    b[_LOSS] = power - b[_RECOVERED] + friction * b[_SPEED]


_advance = steppers.body_stepper(_rhs, _out, _d)


@kernel
def _micro_step(b: np.ndarray) -> float:
    """Longest Runge-Kutta step [s]."""
    fastest = max(b[_FRICTION] / b[_INERTIA], 1.0 / b[_TIME_CONSTANT])
    return min(b[_MICRO_STEP], 1.0 / fastest)


@kernel
def _step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    return _advance(b, w, t, h, _micro_step(b), int(b[_DEGREE]))


LOAD_MOTOR = Component(
    _d, Kernels(_step, _rhs, _out), __doc__, longest_step=steppers.longest_step_by(_d, _micro_step)
)

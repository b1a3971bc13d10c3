"""Speed-controlled drive motor: rotor, PI controller, torque limit, set-point ramp.

    J w' = tau + T,   phi' = w
    T = limit(K_p e + K_i x, +-torque_limit),   e = w_ref - w
    x' = e + (T - (K_p e + K_i x)) / K_p          (anti-windup by back-calculation)
    w_ref' = limit((speed_setpoint - w_ref) / ramp_time_constant, +-maximum_acceleration)

`tau` is the torque of the shaft on the rotor. Electrical power is T w / efficiency when driving and
T w efficiency when braking.

A Runge-Kutta step is never longer than 1 / (fastest own rate), of K_p / J, sqrt(K_i / J), K_i / K_p
(of x while the torque limit acts) and 1 / ramp_time_constant: a light rotor would run away in the
steps of `micro_step`.

Source: K. J. Astrom and T. Hagglund, Advanced PID Control (2006), section 3.5 (anti-windup).
"""

import math

import numpy as np

from herringbone.components.ports import flange, flange_body
from herringbone.core import Component, Declaration, Kernels, Laws, input_, output, parameter, state
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.kernels import steppers
from herringbone.kernels.compiling.jit import kernel

_d = Declaration(
    "drive_motor",
    "Speed-controlled drive motor with torque limit and set-point ramp",
    [
        state("angle", "rad", "rotor angle", steady="rotating"),
        state("speed", "rad/s", "rotor speed", nominal=100.0),
        state("integral", "rad", "integral of the speed error", nominal=0.1),
        state("speed_reference", "rad/s", "set point behind the ramp", nominal=100.0),
        *flange_body("flange"),
        input_("speed_setpoint", "rad/s", "speed set point", quantity=Quantity.SPEED_SETPOINT),
        output("torque", "N.m", "air-gap torque", quantity=Quantity.TORQUE),
        output("electrical_power", "W", "power from the supply, negative when braking",
               quantity=Quantity.ELECTRICAL_POWER),
        parameter("inertia", "kg.m2", "rotor inertia", 0.08, minimum=1e-9,
                  quantity=Quantity.INERTIA),
        parameter("proportional_gain", "N.m.s/rad", "K_p", 30.0, minimum=1e-9),
        parameter("integral_gain", "N.m/rad", "K_i", 600.0, minimum=0),
        parameter("torque_limit", "N.m", "largest torque", 1000.0, minimum=0),
        parameter("maximum_acceleration", "rad/s2", "of the set point", 1e4, minimum=1e-6),
        parameter("ramp_time_constant", "s", "of the set point", 1e-3, minimum=1e-4),
        parameter("efficiency", "1", "electrical to mechanical", 0.93, minimum=0.01, maximum=1),
        parameter("micro_step", "s", "longest Runge-Kutta step", 5e-5, minimum=1e-9, maximum=1e-4,
                  tunable=True, quantity=Quantity.MICRO_STEP),
    ],
    work=steppers.body_work(4, 2),
    roles=[Role.DRIVE],
    ports=[flange("flange")],
)  # fmt: skip

_ANGLE, _SPEED, _INTEGRAL, _REFERENCE = _d.indices("angle", "speed", "integral", "speed_reference")
_TAU, _SETPOINT, _PHI, _W, _A = _d.indices(
    "flange.tau", "speed_setpoint", "flange.phi", "flange.w", "flange.a"
)
_TORQUE, _POWER = _d.indices("torque", "electrical_power")
_INERTIA, _K_P, _K_I, _LIMIT, _MAX_ACCELERATION, _TIME_CONSTANT, _EFFICIENCY = _d.indices(
    "inertia", "proportional_gain", "integral_gain", "torque_limit", "maximum_acceleration",
    "ramp_time_constant", "efficiency",
)  # fmt: skip
_MICRO_STEP, _DEGREE = _d.indices("micro_step", "interface_degree")


@kernel
def _demand(b: np.ndarray) -> float:
    """Torque [N m] before the limit."""
    return b[_K_P] * (b[_REFERENCE] - b[_SPEED]) + b[_K_I] * b[_INTEGRAL]


@kernel
def _ramp(b: np.ndarray) -> float:
    """Acceleration of the set point [rad/s2] before the limit."""
    return (b[_SETPOINT] - b[_REFERENCE]) / b[_TIME_CONSTANT]


@kernel
def _limited(x: float, limit: float) -> float:
    return max(-limit, min(x, limit))


@kernel
def _rates(b: np.ndarray, torque: float, demand: float, ramp: float, dx: np.ndarray) -> None:
    dx[_ANGLE] = b[_SPEED]
    dx[_SPEED] = (b[_TAU] + torque) / b[_INERTIA]
    dx[_INTEGRAL] = b[_REFERENCE] - b[_SPEED] + (torque - demand) / b[_K_P]
    dx[_REFERENCE] = ramp


@kernel
def _rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    demand = _demand(b)
    ramp = _limited(_ramp(b), b[_MAX_ACCELERATION])
    _rates(b, _limited(demand, b[_LIMIT]), demand, ramp, dx)


@kernel
def _motion(b: np.ndarray, torque: float) -> None:
    b[_PHI], b[_W] = b[_ANGLE], b[_SPEED]
    b[_A] = (b[_TAU] + torque) / b[_INERTIA]
    b[_TORQUE] = torque


@kernel
def _out(b: np.ndarray, t: float) -> None:
    torque = _limited(_demand(b), b[_LIMIT])
    _motion(b, torque)
    power = torque * b[_SPEED]
    b[_POWER] = power / b[_EFFICIENCY] if power > 0.0 else power * b[_EFFICIENCY]


_advance = steppers.body_stepper(_rhs, _out, _d)


@kernel
def _micro_step(b: np.ndarray) -> float:
    """Longest Runge-Kutta step [s]."""
    control = max(b[_K_P] / b[_INERTIA], math.sqrt(b[_K_I] / b[_INERTIA]))
    others = max(b[_K_I] / b[_K_P], 1.0 / b[_TIME_CONSTANT])
    return min(b[_MICRO_STEP], 1.0 / max(control, others))


@kernel
def _step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    return _advance(b, w, t, h, _micro_step(b), int(b[_DEGREE]))


def _guess(block: np.ndarray) -> None:
    """At the set point neither ramp nor torque limit act."""
    block[_SPEED] = block[_REFERENCE] = block[_SETPOINT]


@kernel
def _gather(b: np.ndarray, z: np.ndarray) -> None:
    z[0], z[1] = _demand(b), _ramp(b)


@kernel
def _evaluate(b: np.ndarray, z: np.ndarray, f: np.ndarray, k: np.ndarray, e: np.ndarray) -> None:
    for i in range(2):
        limit = b[_LIMIT] if i == 0 else b[_MAX_ACCELERATION]
        f[i] = _limited(z[i], limit)
        e[i] = limit - abs(z[i])
        k[i] = 1.0 if e[i] > 0.0 else 0.0


@kernel
def _apply(b: np.ndarray, t: float, f: np.ndarray, dx: np.ndarray) -> None:
    _motion(b, f[0])
    _rates(b, f[0], _demand(b), f[1], dx)


def _each(block: np.ndarray) -> np.ndarray:
    """Each limit along its own argument."""
    del block
    return np.eye(2)


def _inside(block: np.ndarray) -> np.ndarray:
    """Tangents inside the limits."""
    del block
    return np.ones(2)


def _nothing(block: np.ndarray) -> np.ndarray:
    """A limit is a straight line on both sides of its bend."""
    del block
    return np.zeros((0, 2))


_LAWS = Laws(
    arguments=("torque before the limit", "acceleration of the set point before the limit"),
    values=("torque", "acceleration of the set point"),
    stiff=(0, 1),
    kinks=2,
    gather=_gather,
    evaluate=_evaluate,
    apply=_apply,
    directions=_each,
    mean=_inside,
    sharp=_nothing,
)

DRIVE_MOTOR = Component(
    _d,
    Kernels(_step, _rhs, _out),
    __doc__,
    guess=_guess,
    laws=_LAWS,
    longest_step=steppers.longest_step_by(_d, _micro_step),
)

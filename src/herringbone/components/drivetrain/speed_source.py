"""Speed that is imposed, whatever torque it takes: a large turbine, the grid, a drum.

    w' = (speed_setpoint - w) / time_constant,   phi' = w
    torque = -tau,   power = torque w

`torque` is what the source gives to the shaft while the speed is constant, tau that of the shaft
on the source. The set point is followed with a delay, so that angle and speed are continuous; at
the start the speed is `speed`.

Source: Modelica.Mechanics.Rotational.Sources.Speed with exact=false (names and signs).
"""

import numpy as np

from herringbone.components.ports import flange
from herringbone.core import Component, Declaration, Kernels, input_, output, parameter, state
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.kernels import steppers
from herringbone.kernels.compiling.jit import kernel

_d = Declaration(
    "speed_source",
    "Imposed speed, whatever torque it takes",
    [
        state("angle", "rad", "angle of rotation", steady="rotating"),
        state("speed", "rad/s", "angular velocity", nominal=100.0),
        input_("flange.tau", "N.m", "torque on the source at the flange"),
        input_("speed_setpoint", "rad/s", "speed set point", quantity=Quantity.SPEED_SETPOINT),
        output("flange.phi", "rad", "angle of the flange, positive in driving direction",
               nodes=True, rate="flange.w"),
        output("flange.w", "rad/s", "angular velocity of the flange", nodes=True, rate="flange.a",
               quantity=Quantity.SPEED, place="flange"),
        output("flange.a", "rad/s2", "angular acceleration of the flange",
               feedthrough=("speed_setpoint",)),
        output("torque", "N.m", "torque that the source gives", feedthrough=("flange.tau",),
               quantity=Quantity.TORQUE),
        output("power", "W", "power that the source gives", feedthrough=("flange.tau",)),
        parameter("time_constant", "s", "of the speed behind its set point", 1e-2, minimum=1e-4),
        parameter("micro_step", "s", "longest Runge-Kutta step", 5e-5, minimum=1e-9, maximum=1e-4,
                  tunable=True, quantity=Quantity.MICRO_STEP),
    ],
    work=steppers.body_work(2, 2),
    roles=[Role.CONTROLLER],
    ports=[flange("flange")],
)  # fmt: skip

_ANGLE, _SPEED, _TAU, _SETPOINT = _d.indices("angle", "speed", "flange.tau", "speed_setpoint")
_PHI, _W, _A, _TORQUE, _POWER = _d.indices("flange.phi", "flange.w", "flange.a", "torque", "power")
_TIME_CONSTANT, _MICRO_STEP, _DEGREE = _d.indices("time_constant", "micro_step", "interface_degree")


@kernel
def _rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    dx[_ANGLE] = b[_SPEED]
    dx[_SPEED] = (b[_SETPOINT] - b[_SPEED]) / b[_TIME_CONSTANT]


@kernel
def _out(b: np.ndarray, t: float) -> None:
    b[_PHI], b[_W] = b[_ANGLE], b[_SPEED]
    b[_A] = (b[_SETPOINT] - b[_SPEED]) / b[_TIME_CONSTANT]
    b[_TORQUE] = -b[_TAU]
    b[_POWER] = -b[_TAU] * b[_SPEED]


_advance = steppers.body_stepper(_rhs, _out, _d)


@kernel
def _step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    return _advance(b, w, t, h, b[_MICRO_STEP], int(b[_DEGREE]))


def _guess(block: np.ndarray) -> None:
    """The set point is reached in steady rotation."""
    block[_SPEED] = block[_SETPOINT]


SPEED_SOURCE = Component(
    _d,
    Kernels(_step, _rhs, _out),
    __doc__,
    guess=_guess,
    longest_step=steppers.longest_step(_d, "micro_step"),
)

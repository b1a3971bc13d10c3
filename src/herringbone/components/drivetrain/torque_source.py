"""Torque that depends on speed and angle: a motor, an engine, a propeller, the road, a hoist.

    x = w / nominal_speed
    mean = torque_setpoint + nominal_torque (constant_share + linear_share x + quadratic_share x |x|
           + dry_share w / sqrt(w^2 + smooth_speed^2))
    tau = mean + R sum of amplitude cos(order phi + phase),   torque = tau,   power = tau w

tau is the torque on the body at the flange, positive in driving direction: a load has a negative
`nominal_torque`. A propeller, a fan, the drag of a vehicle: `quadratic_share` 1; an engine with a
governor of droop d: constant_share 1 + 1/d, linear_share -1/d; rolling resistance: `dry_share`.

Orders are periods per revolution: an electric machine of p pole pairs has 6 p, a four-stroke engine
of n cylinders n/2 and its multiples. They come in over the first `ramp_time` from time 0, so that
a run can start in the equilibrium of the mean torque,

    R = t^3 (10 - 15 t + 6 t^2),   t = time / ramp_time, at most 1;   ramp_time 0: R = 1

No inertia: join it to a body, of which a rotating inertia has a third flange.

Source: Modelica.Mechanics.Rotational.Sources.Torque, LinearSpeedDependentTorque and
QuadraticSpeedDependentTorque (names and signs).
"""

import math
from fractions import Fraction

import numpy as np

from herringbone.components.ports import flange
from herringbone.core import (
    Component,
    Declaration,
    Kernels,
    Laws,
    input_,
    output,
    parameter,
)
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.kernels import steppers
from herringbone.kernels.compiling.jit import kernel
from herringbone.kernels.elementary import cosine

ORDERS = 6
"""Room for orders."""
_MOTION = ("flange.phi", "flange.w")
_INPUTS = (*_MOTION, "torque_setpoint")


def _orders() -> list:
    """Parameters of the orders; all amplitudes are zero."""
    found = []
    for k in range(1, ORDERS + 1):
        found += [
            parameter(f"order_{k}.order", "1", f"periods per revolution of order {k}", float(k),
                      minimum=0),
            parameter(f"order_{k}.amplitude", "N.m", f"torque of order {k}", 0.0, minimum=0),
            parameter(f"order_{k}.phase", "rad", f"phase of order {k}", 0.0),
        ]  # fmt: skip
    return found


_d = Declaration(
    "torque_source",
    "Torque by speed and angle: engine, electric machine, propeller, vehicle",
    [
        input_("flange.phi", "rad", "angle of the flange"),
        input_("flange.w", "rad/s", "angular velocity of the flange"),
        input_("torque_setpoint", "N.m", "added to the torque by speed"),
        output("flange.tau", "N.m", "torque on the body", feedthrough=_INPUTS, nodes=True),
        output("torque", "N.m", "torque on the body", feedthrough=_INPUTS,
               quantity=Quantity.TORQUE),
        output("power", "W", "power given to the body", feedthrough=_INPUTS),
        parameter("nominal_torque", "N.m", "at the nominal speed; of a load negative", 0.0),
        parameter("nominal_speed", "rad/s", "at which the shares hold", 100.0, minimum=1e-6),
        parameter("constant_share", "1", "of torque that does not depend on speed", 0.0),
        parameter("linear_share", "1", "of torque that grows with speed", 0.0),
        parameter("quadratic_share", "1", "of torque that grows with speed squared", 0.0),
        parameter("dry_share", "1", "of torque that has the sign of the speed", 0.0),
        parameter("smooth_speed", "rad/s", "speed below which the dry share fades", 1.0,
                  minimum=1e-6),
        parameter("ramp_time", "s", "time over which the orders come in", 0.02, minimum=0),
        *_orders(),
    ],
    tables=1,
    work=steppers.element_work(len(_INPUTS)),
    roles=[Role.SOURCE],
    ports=[flange("flange")],
)  # fmt: skip

_PHI, _W, _SETPOINT = _d.indices(*_INPUTS)
_TAU, _TORQUE, _POWER = _d.indices("flange.tau", "torque", "power")
_NOMINAL, _NOMINAL_SPEED, _CONSTANT, _LINEAR, _QUADRATIC, _DRY, _SMOOTH, _RAMP, _DEGREE = (
    _d.indices(
        "nominal_torque", "nominal_speed", "constant_share", "linear_share", "quadratic_share",
        "dry_share", "smooth_speed", "ramp_time", "interface_degree",
    )
)  # fmt: skip
_TIME = _d.first_table
"""Where the time of the law stands [s]."""
_FIRST, _ROW = _d.index["order_1.order"], 3
_TWO_PI = 2.0 * math.pi
_FINEST = 1000
"""Largest denominator of an order."""


@kernel
def _by_speed(b: np.ndarray) -> float:
    """Torque of the law of speed [N m]."""
    w = b[_W]
    x = w / b[_NOMINAL_SPEED]
    share = b[_CONSTANT] + x * (b[_LINEAR] + b[_QUADRATIC] * abs(x))
    share += b[_DRY] * w / math.sqrt(w * w + b[_SMOOTH] * b[_SMOOTH])
    return b[_NOMINAL] * share


@kernel
def _by_angle(b: np.ndarray) -> float:
    """Torque of the orders [N m]."""
    value = 0.0
    for k in range(ORDERS):
        row = _FIRST + _ROW * k
        if b[row + 1] > 0.0:
            turns = b[row] * b[_PHI] / _TWO_PI
            value += b[row + 1] * cosine(_TWO_PI * (turns - math.floor(turns)) + b[row + 2])
    return value


@kernel
def _ramp(b: np.ndarray, t: float) -> float:
    """Factor R of the orders."""
    if t >= b[_RAMP]:
        return 1.0
    s = max(0.0, t / b[_RAMP])
    return s * s * s * (10.0 + s * (6.0 * s - 15.0))


@kernel
def _rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    pass


@kernel
def _write(b: np.ndarray, torque: float) -> None:
    b[_TAU] = b[_TORQUE] = torque
    b[_POWER] = torque * b[_W]


@kernel
def _out(b: np.ndarray, t: float) -> None:
    _write(b, b[_SETPOINT] + _by_speed(b) + _ramp(b, t) * _by_angle(b))


_advance = steppers.element_stepper(_out, _d)


@kernel
def _step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    return _advance(b, w, t, h, int(b[_DEGREE]))


def _breakpoints(block: np.ndarray) -> tuple[float, ...]:
    """End of the ramp."""
    return (float(block[_RAMP]),)


@kernel
def _gather(b: np.ndarray, z: np.ndarray) -> None:
    z[0], z[1] = b[_PHI], b[_W]


@kernel
def _evaluate(b: np.ndarray, z: np.ndarray, f: np.ndarray, k: np.ndarray, e: np.ndarray) -> None:
    b[_PHI], b[_W] = z[0], z[1]
    f[0] = _by_speed(b) + _ramp(b, b[_TIME]) * _by_angle(b)
    w, smooth = b[_W], b[_SMOOTH]
    slope = (b[_LINEAR] + 2.0 * b[_QUADRATIC] * abs(w) / b[_NOMINAL_SPEED]) / b[_NOMINAL_SPEED]
    square = w * w + smooth * smooth
    slope += b[_DRY] * smooth * smooth / (square * math.sqrt(square))
    k[0] = b[_NOMINAL] * slope
    e[0] = w if b[_QUADRATIC] != 0.0 else 1.0


@kernel
def _apply(b: np.ndarray, t: float, f: np.ndarray, dx: np.ndarray) -> None:
    _write(b, b[_SETPOINT] + f[0])


def _along_speed(block: np.ndarray) -> np.ndarray:
    del block
    return np.array([[0.0, 1.0]])


def _mean(block: np.ndarray) -> np.ndarray:
    """At the nominal speed, without the dry share."""
    slope = (block[_LINEAR] + 2.0 * block[_QUADRATIC]) / block[_NOMINAL_SPEED]
    return np.array([block[_NOMINAL] * slope])


def _bends(block: np.ndarray) -> bool:
    """True unless the torque is a straight line over speed."""
    amplitudes = [block[_FIRST + _ROW * k + 1] for k in range(ORDERS)]
    return bool(block[_QUADRATIC] != 0.0 or block[_DRY] != 0.0 or any(amplitudes))


def _periods(block: np.ndarray) -> tuple[tuple[int, Fraction], ...]:
    """Orders are rational numbers, of small denominators."""
    rows = range(_FIRST, _FIRST + _ROW * ORDERS, _ROW)
    orders = [block[row] for row in rows if block[row] > 0.0 and block[row + 1] > 0.0]
    turns = [1 / Fraction(float(order)).limit_denominator(_FINEST) for order in orders]
    return tuple((0, turn) for turn in turns)


def _settle(block: np.ndarray) -> None:
    block[_RAMP] = 0.0


_LAWS = Laws(
    arguments=("angle", "angular velocity"),
    values=("torque by speed and angle",),
    stiff=(0,),
    kinks=1,
    gather=_gather,
    evaluate=_evaluate,
    apply=_apply,
    directions=_along_speed,
    mean=_mean,
    needed=_bends,
    clock=_TIME,
    periods=_periods,
    settle=_settle,
)

TORQUE_SOURCE = Component(
    _d, Kernels(_step, _rhs, _out), __doc__, breakpoints=_breakpoints, laws=_LAWS
)

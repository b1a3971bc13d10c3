"""Bench controller: set points of a test cycle, piecewise linear in time, without state.

    speed_setpoint  = speed_factor speed(t)                                          (drive motor)
    torque_setpoint = torque_factor gear_ratio torque(t) min(1, t / load_ramp_time)  (load motor)

The cycle is a CSV file of time [s], speed [r/min or rad/s] and torque [N.m]; the torque is the
*pinion* torque, so that the load motor behind the gearbox gets gear_ratio times as much. Before the
first row and after the last one the set points are constant. `load_ramp_time` > 0 applies the
torque gradually from zero, linearly: the thesis' start of a simulation at speed.

Source: the test control of the thesis, chapter 5 (TCT1000).
"""

import math
from collections.abc import Mapping

import numpy as np

from herringbone.components.resources.loader import Refusal, ResourceLoader
from herringbone.components.shipped_pair import SHIPPED_PAIR
from herringbone.core import (
    Column,
    Component,
    Declaration,
    Kernels,
    ParameterError,
    Text,
    output,
    parameter,
)
from herringbone.core.declaring.pair_values import PairValues
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.kernels import steppers
from herringbone.kernels.compiling.jit import kernel, seldom

ROWS = 256
"""Most rows of a cycle."""
_COLUMNS = (Column("time", ("s",)), Column("speed", ("r/min", "rad/s")), Column("torque", ("N.m",)))
_WIDTH = len(_COLUMNS)
_PER_MINUTE = 0

_d = Declaration(
    "bench_controller",
    "Set points of a test cycle, from a CSV of time, speed and torque",
    [
        output("speed_setpoint", "rad/s", "for the drive motor", nodes=True,
               quantity=Quantity.SPEED_SETPOINT),
        output("torque_setpoint", "N.m", "for the load motor", nodes=True,
               quantity=Quantity.TORQUE_SETPOINT),
        parameter(
            "gear_ratio",
            "1",
            "load torque per pinion torque",
            SHIPPED_PAIR.gear_ratio,
            minimum=1e-6,
            quantity=Quantity.GEAR_RATIO,
        ),
        parameter("speed_factor", "1", "multiplies the cycle's speed", 1.0),
        parameter("torque_factor", "1", "multiplies the cycle's torque", 1.0),
        parameter(
            "load_ramp_time",
            "s",
            "torque rises from zero over this time",
            0.0,
            minimum=0,
            quantity=Quantity.LOAD_RAMP_TIME,
        ),
    ],
    texts=[Text("cycle", "test cycle, CSV of time, speed, torque", "loaded.csv", _COLUMNS)],
    tables=1 + 3 * ROWS,
    roles=[Role.CONTROLLER],
)  # fmt: skip

_SPEED, _TORQUE = _d.indices("speed_setpoint", "torque_setpoint")
_RATIO, _SPEED_FACTOR, _TORQUE_FACTOR, _RAMP, _DEGREE = _d.indices(
    "gear_ratio", "speed_factor", "torque_factor", "load_ramp_time", "interface_degree"
)
_COUNT = _d.first_table
_TIMES = _COUNT + 1
_SPEEDS, _TORQUES = _TIMES + ROWS, _TIMES + 2 * ROWS


@kernel
def _rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    pass


@kernel
def _out(b: np.ndarray, t: float) -> None:
    last = int(b[_COUNT]) - 1
    i = 0
    while i < last and t >= b[_TIMES + i + 1]:
        i += 1
    if i == last or t <= b[_TIMES]:
        speed, torque = b[_SPEEDS + i], b[_TORQUES + i]
    else:
        f = (t - b[_TIMES + i]) / (b[_TIMES + i + 1] - b[_TIMES + i])
        speed = b[_SPEEDS + i] + f * (b[_SPEEDS + i + 1] - b[_SPEEDS + i])
        torque = b[_TORQUES + i] + f * (b[_TORQUES + i + 1] - b[_TORQUES + i])
    if t < b[_RAMP]:
        torque *= max(0.0, t / b[_RAMP])
    b[_SPEED] = b[_SPEED_FACTOR] * speed
    b[_TORQUE] = b[_TORQUE_FACTOR] * b[_RATIO] * torque


_advance = steppers.source_stepper(_out, _d)


@kernel
def _step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    return _advance(b, t, h, int(b[_DEGREE]))


_TOO_LONG, _NOT_RISING = 1, 2
_REFUSALS = (
    Refusal(f": %g rows; at most {ROWS}"),
    Refusal(": time does not rise from %g s to %g s"),
)


@seldom
def _load(
    values: np.ndarray, shape: np.ndarray, b: np.ndarray, s: np.ndarray, report: np.ndarray
) -> int:
    rows = shape[0]
    if rows > ROWS:
        report[0] = rows
        return _TOO_LONG
    b[_COUNT] = rows
    for i in range(rows):
        at = _WIDTH * (i + 1)
        speed = values[at + 1]
        b[_TIMES + i] = values[at]
        b[_SPEEDS + i] = speed * math.pi / 30.0 if values[1] == _PER_MINUTE else speed
        b[_TORQUES + i] = values[at + 2]
        if i > 0 and b[_TIMES + i] <= b[_TIMES + i - 1]:
            report[0], report[1] = b[_TIMES + i - 1], b[_TIMES + i]
            return _NOT_RISING
    return 0


def _breakpoints(block: np.ndarray) -> tuple[float, ...]:
    """Kinks of the cycle and the end of the load ramp."""
    times = block[_TIMES : _TIMES + int(block[_COUNT])]
    return (*times.tolist(), float(block[_RAMP]))


def _of_pair(pair: PairValues, own: Mapping[str, float]) -> dict[str, float]:
    """The gear ratio; see `Component.of_pair`."""
    del own
    return {"gear_ratio": pair.gear_ratio}


def _commanded(block: np.ndarray, quantity: Quantity, value: float) -> dict[str, float]:
    """The factor with which a constant cycle has a value; see `Component.commanded`."""
    first, factor = {
        Quantity.SPEED_SETPOINT: (_SPEEDS, "speed_factor"),
        Quantity.TORQUE_SETPOINT: (_TORQUES, "torque_factor"),
    }[quantity]
    column = block[first : first + int(block[_COUNT])]
    lowest, highest = float(column.min()), float(column.max())
    if lowest != highest or lowest == 0.0:
        unit = _d.variable(factor.replace("factor", "setpoint")).unit
        raise ParameterError(
            f"the {quantity} of its cycle goes from {lowest:.6g} to {highest:.6g} {unit}; take a "
            "cycle whose values are constant and not zero"
        )
    return {factor: value / lowest}


BENCH_CONTROLLER = Component(
    _d,
    Kernels(_step, _rhs, _out),
    __doc__,
    load=ResourceLoader(_d.texts, _load, _REFUSALS, scratch=1),
    breakpoints=_breakpoints,
    curve=2,  # a linear cycle times a linear ramp
    of_pair=_of_pair,
    commanded=_commanded,
)

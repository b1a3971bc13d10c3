"""A value that rises evenly from zero: the set point of a part that would begin with all of it.

    value = final_value min(1, t / load_ramp_time)

Every output gives that value, each in the SI unit of its own: the one is connected whose unit is
that of the input. It has no state.
"""

import numpy as np

from herringbone.core import Component, Declaration, Kernels, output, parameter
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.kernels import steppers
from herringbone.kernels.compiling.jit import kernel

_OUTPUTS = {"ratio": "1", "torque": "N.m", "speed": "rad/s", "force": "N", "power": "W"}

_d = Declaration(
    "rising_value",
    "Set point that rises evenly from zero",
    [
        *(
            output(name, unit, f"the value, in {unit}", nodes=True, quantity=Quantity.RISING_VALUE)
            for name, unit in _OUTPUTS.items()
        ),
        parameter("final_value", "1", "in the SI unit of the output that is connected", 1.0,
                  quantity=Quantity.FINAL_VALUE),
        parameter("load_ramp_time", "s", "the value rises from zero over this time", 0.0,
                  minimum=0, quantity=Quantity.LOAD_RAMP_TIME),
    ],
    roles=[Role.SET_POINT],
)  # fmt: skip

_RATIO, _TORQUE, _SPEED, _FORCE, _POWER = _d.indices(*_OUTPUTS)
_FINAL, _RAMP, _DEGREE = _d.indices("final_value", "load_ramp_time", "interface_degree")


@kernel
def _rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    pass


@kernel
def _out(b: np.ndarray, t: float) -> None:
    value = b[_FINAL]
    if t < b[_RAMP]:
        value *= max(0.0, t / b[_RAMP])
    b[_RATIO] = b[_TORQUE] = b[_SPEED] = b[_FORCE] = b[_POWER] = value


_advance = steppers.source_stepper(_out, _d)


@kernel
def _step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    return _advance(b, t, h, int(b[_DEGREE]))


def _breakpoints(block: np.ndarray) -> tuple[float, ...]:
    """End of the ramp."""
    return (float(block[_RAMP]),)


RISING_VALUE = Component(_d, Kernels(_step, _rhs, _out), __doc__, breakpoints=_breakpoints, curve=1)

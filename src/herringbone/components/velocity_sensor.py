"""Velocity sensor with a sampled recorder: an observer that acts on nothing.

The signal passes filters, each there if its parameter is not 0, in this order:

    high pass and low pass of the sensor, Butterworth of order 2
    anti-alias filter, Butterworth of order 8 at 0.4 sampling_hz

All are made of sections of order 2 with the states x, z and the angular corner frequency w:

    x' = w z,   z' = w (u - x - d z),   low pass: x,   high pass: u - x - d z

d = sqrt(2) at order 2, and 2 sin((2 k - 1) pi / 16), k = 1 ... 4, at order 8. Sections that are
switched off run on unheard, at the corner of the anti-alias filter.

Sample k is taken at first_sample + k / sampling_hz, inside of communication steps too, clipped to
+-range, rounded and held. Rounded values are the 2^bits multiples of d = 2 range / 2^bits from
-range to range - d; 0 bits: not rounded. `saturation_count` is how many samples were clipped. A
line at f > sampling_hz / 2 shows at |f - n sampling_hz|.

Before the first sample the output is 0. A sample at the begin of the first step is taken in this
step, and shown at its end: at first_sample = 0 the output at t = 0 is 0, too.

One sensor feels one direction at one place: connect `velocity` to a velocity of the housing, such
as `pinion_left.v_z`; take one instance per sensor. Points of the boss face between the seats'
degrees of freedom are no variables of the housing;
`herringbone.analysis.figures.sensing.velocity_sensor` computes them from the modal data afterwards,
with the same parameters.

Samples exist in time steps only: the native FMU offers no model exchange, and the monolithic
solution keeps the held value.

Source: A. V. Oppenheim, R. W. Schafer, Discrete-Time Signal Processing, 3rd ed., chapter 4 and
appendix B.
"""

import math

import numpy as np

from herringbone.core import (
    Component,
    Declaration,
    Kernels,
    StateVector,
    input_,
    local,
    output,
    parameter,
)
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.kernels import steppers
from herringbone.kernels.compiling.jit import kernel
from herringbone.kernels.sampling import (
    ANTI_ALIAS_CORNER,
    ANTI_ALIAS_ORDER,
    converted,
    sampler_stepper,
    sampler_work,
)

_DAMPING = (  # d of high pass, low pass and the sections of the anti-alias filter
    math.sqrt(2.0),
    math.sqrt(2.0),
    *(2.0 * math.sin(k * math.pi / (2 * ANTI_ALIAS_ORDER)) for k in range(1, ANTI_ALIAS_ORDER, 2)),
)
_SECTIONS = len(_DAMPING)
_HIGH, _LOW, _ANTI, _LAST = 0, 1, 2, _SECTIONS - 1
_TWO_PI = 2.0 * math.pi
_STEPS_PER_PERIOD = 30.0
"""Runge-Kutta steps per period of the highest corner frequency: phase errors near 1e-5."""

_d = Declaration(
    "velocity_sensor",
    "Velocity sensor with band limit, sampling, clipping and quantisation",
    [
        input_("velocity", "m/s", "velocity at the sensor"),
        output("velocity_sampled", "m/s", "last sample, held"),
        output("saturation_count", "1", "samples that were clipped"),
        local("velocity_filtered", "m/s", "what the sampler sees"),
        local("next_sample", "1", "number of the next sample"),
        parameter("high_pass_hz", "Hz", "corner of the sensor's high pass, 0: none", 10.0,
                  minimum=0, maximum=1e5),
        parameter("low_pass_hz", "Hz", "corner of the sensor's low pass, 0: none", 0.0,
                  minimum=0, maximum=1e5),
        parameter("anti_alias", "1", "1: with anti-alias filter, 0: without", 0.0,
                  minimum=0, maximum=1, whole=True),
        parameter("sampling_hz", "Hz", "sampling rate", 2000.0, minimum=1e-3, maximum=1e5),
        parameter("first_sample", "s", "time of sample 0", 0.0, minimum=0),
        parameter("range", "m/s", "largest velocity, either sign", 0.05, minimum=1e-9),
        parameter("bits", "1", "of the converter over both signs, 0: no quantisation", 16.0,
                  minimum=0, maximum=32, whole=True),
        parameter("micro_step", "s", "longest Runge-Kutta step", 2e-5, minimum=1e-9, maximum=1e-4,
                  quantity=Quantity.MICRO_STEP),
    ],
    vectors=[
        StateVector(name, "m/s", f"state {name} of the filters' sections", _SECTIONS)
        for name in ("x", "z")
    ],
    work=sampler_work(2 * _SECTIONS, 1),
    roles=[Role.SENSOR],
)  # fmt: skip

_VELOCITY, _SAMPLED, _SATURATED, _FILTERED, _NEXT = _d.indices(
    "velocity", "velocity_sampled", "saturation_count", "velocity_filtered", "next_sample"
)
_HIGH_PASS, _LOW_PASS, _ANTI_ALIAS, _RATE, _FIRST, _RANGE, _BITS, _MICRO_STEP, _DEGREE = _d.indices(
    "high_pass_hz", "low_pass_hz", "anti_alias", "sampling_hz", "first_sample", "range", "bits",
    "micro_step", "interface_degree",
)  # fmt: skip


@kernel
def _high_passed(b: np.ndarray) -> float:
    rest = b[_VELOCITY] - b[_HIGH] - _DAMPING[_HIGH] * b[_SECTIONS + _HIGH]
    return rest if b[_HIGH_PASS] > 0.0 else b[_VELOCITY]


@kernel
def _band_limited(b: np.ndarray) -> float:
    return b[_LOW] if b[_LOW_PASS] > 0.0 else _high_passed(b)


@kernel
def _section(b: np.ndarray, dx: np.ndarray, k: int, corner_hz: float, u: float) -> None:
    """Derivatives of section k that is fed with u."""
    w = _TWO_PI * (corner_hz if corner_hz > 0.0 else ANTI_ALIAS_CORNER * b[_RATE])
    dx[k] = w * b[_SECTIONS + k]
    dx[_SECTIONS + k] = w * (u - b[k] - _DAMPING[k] * b[_SECTIONS + k])


@kernel
def _rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    _section(b, dx, _HIGH, b[_HIGH_PASS], b[_VELOCITY])
    _section(b, dx, _LOW, b[_LOW_PASS], _high_passed(b))
    _section(b, dx, _ANTI, 0.0, _band_limited(b))
    for k in range(_ANTI + 1, _SECTIONS):
        _section(b, dx, k, 0.0, b[k - 1])


@kernel
def _out(b: np.ndarray, t: float) -> None:
    """The held outputs change at samples only."""
    b[_FILTERED] = b[_LAST] if b[_ANTI_ALIAS] > 0.0 else _band_limited(b)


@kernel
def _sample(b: np.ndarray) -> None:
    if abs(b[_FILTERED]) > b[_RANGE]:
        b[_SATURATED] += 1.0
    b[_SAMPLED] = converted(b[_FILTERED], b[_RANGE], int(b[_BITS]))


_advance = sampler_stepper(
    steppers.body_stepper(_rhs, _out, _d), _sample, _d, (_NEXT, _RATE, _FIRST)
)


@kernel
def _micro_step(b: np.ndarray) -> float:
    highest = max(b[_HIGH_PASS], b[_LOW_PASS], ANTI_ALIAS_CORNER * b[_RATE])
    return min(b[_MICRO_STEP], 1.0 / (_STEPS_PER_PERIOD * highest))


@kernel
def _step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    return _advance(b, w, t, h, _micro_step(b), int(b[_DEGREE]))


VELOCITY_SENSOR = Component(
    _d,
    Kernels(_step, _rhs, _out),
    __doc__,
    samples=True,
    longest_step=steppers.longest_step_by(_d, _micro_step),
)

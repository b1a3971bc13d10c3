"""How a body with a sampler advances over a macro step: in pieces that end at the samples."""

import math
from collections.abc import Callable

import numpy as np

from herringbone.core.declaring.declaration import Declaration
from herringbone.kernels.compiling.jit import inner, kernel
from herringbone.kernels.signals import STRIDE, evaluate, monomial
from herringbone.kernels.steppers import MOST_MICRO_STEPS, TOO_LONG, body_work

ANTI_ALIAS_ORDER = 8
ANTI_ALIAS_CORNER = 0.4
"""Corner frequency over sampling rate."""
_EARLY = 1e-6
"""A sample this share of a period behind the end of a macro step still belongs to it."""
_MOST_SAMPLES = 2.0**53
"""From here on a number has no successor; 2800 years at 1e5 Hz."""


@kernel
def converted(velocity: float, limit: float, bits: int) -> float:
    """Velocity [m/s] behind a converter of `bits` over +-`limit` [m/s]; 0 bits: clipped only."""
    clipped = max(-limit, min(velocity, limit))
    if bits == 0:
        return clipped
    half = 0.5
    for _ in range(bits):
        half *= 2.0
    digit = limit / half
    return digit * min(math.floor(clipped / digit + 0.5), half - 1.0)


def sampler_work(state_count: int, input_count: int) -> int:
    """Length of the work space that a sampler's stepper needs."""
    return body_work(state_count, input_count) + 2 * STRIDE * input_count


def sampler_stepper(
    body: Callable[[np.ndarray, np.ndarray, float, float, float, int], int],
    sample: Callable[[np.ndarray], None],
    declaration: Declaration,
    clock: tuple[int, int, int],
) -> Callable[[np.ndarray, np.ndarray, float, float, float, int], int]:
    """Compile the step of a body that samples.

    Sample k lies at first + k / rate and is taken once: k is counted in the block, so that rounding
    of time neither doubles nor drops one. A sample at the end of a macro step belongs to this step.
    Samples before the start of the first step are left out, as are those from 2^53 on, which cannot
    be counted.

    Args:
        body: made by `body_stepper`, of a component whose outputs have no nodes.
        sample: takes a sample from the block, in which `out` has just been evaluated.
        declaration: of the component.
        clock: indices in the block of the number of the next sample, of the sampling rate [Hz] and
            of the first sample's time [s].

    Returns:
        step(b, w, t, h, micro_step, degree) -> int, as `body_stepper`; `w` is `sampler_work` long.
        A micro step must be shorter than a sampling period.
    """
    first_input, inputs = declaration.first_input, len(declaration.inputs)
    reals = STRIDE * inputs
    kept = body_work(declaration.state_count, inputs)
    polynomial = kept + reals
    number, rate, first = clock

    @inner(declaration.name)
    def restrict_inputs(b: np.ndarray, w: np.ndarray, degree: int, c: float, end: float) -> None:
        """Nodes of the inputs between two places of the macro step."""
        for at in range(0, reals, STRIDE):
            for node in range(degree + 1):
                place = c + (end - c) * node / max(degree, 1)
                b[first_input + at + node] = evaluate(w, polynomial + at, degree, place)

    @inner(declaration.name)
    def step(
        b: np.ndarray, w: np.ndarray, t: float, h: float, micro_step: float, degree: int
    ) -> int:
        if not h <= MOST_MICRO_STEPS * micro_step:
            return TOO_LONG
        for i in range(reals):
            w[kept + i] = b[first_input + i]
        for at in range(0, reals, STRIDE):
            monomial(b, first_input + at, degree, w, polynomial + at)
        reached = min((t - b[first]) * b[rate] - _EARLY, _MOST_SAMPLES)
        b[number] = max(b[number], math.ceil(reached))
        c, status, sampling = 0.0, 0, True
        while sampling and status == 0:
            due = b[first] + b[number] / b[rate] - t
            sampling = due <= h + _EARLY / b[rate] and b[number] < _MOST_SAMPLES
            end = max(c, min(due / h, 1.0)) if sampling and h > 0.0 else 1.0
            restrict_inputs(b, w, degree, c, end)
            status = body(b, w, t + c * h, (end - c) * h, micro_step, degree)
            if sampling:
                sample(b)
                b[number] += 1.0
            c = end
        for i in range(reals):
            b[first_input + i] = w[kept + i]
        return status

    return step

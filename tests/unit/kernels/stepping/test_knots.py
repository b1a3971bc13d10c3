"""Steps that follow a tolerance, over knots at which the curvature of a rate jumps."""

import numpy as np
import pytest

from herringbone.core.declaring.declaration import Declaration
from herringbone.core.declaring.variable import local, parameter, state
from herringbone.kernels.compiling.jit import kernel
from herringbone.kernels.stepping.adaptive import adaptive_stepper, adaptive_work
from herringbone.kernels.stepping.explicit import TOO_SMALL

PATH = Declaration(
    "path",
    "A way whose speed bends at one time",
    [
        state("x", "m", "way"),
        local("next_inner_step", "s", "next inner step"),
        parameter("knot", "s", "time at which the speed begins to bend", 0.0),
        parameter("jump", "1", "of the speed's curvature [m/s3]", 0.0),
        parameter("longest", "s", "longest inner step", 1.0),
    ],
)
AT, JUMP, NEXT, LONGEST = PATH.indices("knot", "jump", "next_inner_step", "longest")
STEP, TOLERANCE = 1e-5, 1e-8
UNSEEN = 10.0
"""Error over the tolerance of one step of Simpson's rule with the knot at a third of it: Peano's
kernel has its maximum there, 1/324."""
LATE = 3.0
"""What a step errs, over what its second differences show, as the knot nears its end."""


@kernel
def rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    """Speed at a time [s]."""
    since = max(0.0, t - b[AT])
    dx[0] = 0.5 * b[JUMP] * since * since


@kernel
def out(b: np.ndarray, t: float) -> None:
    """There are no outputs."""


@kernel
def longest(b: np.ndarray, w: np.ndarray) -> float:
    """Of an inner step [s]."""
    return b[LONGEST]


@pytest.fixture(scope="module")
def advance():
    return adaptive_stepper(rhs, out, PATH, "next_inner_step", longest)


def errors(advance, inner, count):
    """Over the tolerance, for knots at many places of the first inner step [s] of so many."""
    found = []
    jump = 324.0 * UNSEEN * TOLERANCE / inner**3
    for knot in np.linspace(0.0, inner, 98)[1:-1]:
        b, w = np.zeros(PATH.size), np.zeros(adaptive_work(1, 0))
        b[[AT, JUMP, NEXT, LONGEST]] = knot, jump, inner, 1.0
        assert advance(b, w, 0.0, count * inner, TOLERANCE, 0) == 0
        found.append(abs(b[0] - jump * (count * inner - knot) ** 3 / 6.0) / TOLERANCE)
    return np.array(found)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_a_step_that_has_none_before_sees_knots(advance, count):
    """As the whole communication step, where nothing is known of the curvature before; and where a
    next one shows what this one hid, and both are taken again. Unseen it errs 10 times as much.
    """
    assert errors(advance, STEP, count).max() < LATE


@pytest.mark.parametrize(("inner", "status"), [(1e-7, 0), (1e-9, TOO_SMALL), (1e-16, TOO_SMALL)])
def test_steps_come_to_an_end(advance, inner, status):
    """1e5 inner steps in 10 ms are many for a gearbox; 1e7 of them are told to be too many."""
    b, w = np.zeros(PATH.size), np.zeros(adaptive_work(1, 0))
    b[[NEXT, LONGEST]] = inner
    assert advance(b, w, 0.0, 0.01, TOLERANCE, 0) == status

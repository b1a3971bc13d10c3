"""The next macro step, from what coupling and inner steps err in the present one."""

from types import SimpleNamespace

import numpy as np
import pytest

from herringbone.cosim.layouts.adaptive import WANTED, new_adaptive
from herringbone.cosim.layouts.inner_stepping import TO_BE, InnerStepping, lengthened
from herringbone.cosim.layouts.measured import measured_signals
from herringbone.cosim.loops.adaptive_step.ladder import RUNGS
from herringbone.cosim.loops.adaptive_step.step_choice import (
    HELD_BETWEEN_ROWS,
    choose_inner_steps,
    inner_steps,
    next_rung,
    too_much,
)
from herringbone.cosim.loops.adaptive_step.step_error import COUPLING, INNER_STEPS

TOLERANCE = 1e-5
AIM = TOLERANCE / (1.0 + 40.0 * TOLERANCE)
DEGREE, ORDER = 4, 6
HERE = RUNGS.index(240)


def after_many(coupling, inner_error, most=1.0):
    """Step control after many steps of 240 ticks with these errors.

    Inner steps are 60 ticks long, one from node to node, and may be `most` times longer.
    """
    one = np.array([0], dtype=np.int64)
    nodes = SimpleNamespace(degree=DEGREE, unknown=one, group=one)
    inner = lengthened(SimpleNamespace(parts=()), InnerStepping(60.0, {}, most), 1.0)
    found = new_adaptive(
        nodes, np.array(RUNGS, dtype=np.int64), measured=measured_signals(nodes, one),
        tolerance=TOLERANCE, last=10**6, memory=1.0, aim=1.0, held=HELD_BETWEEN_ROWS, inner=inner,
        times=np.zeros(2), room=np.zeros((7, 7)),
    )  # fmt: skip
    found.error[[COUPLING, INNER_STEPS]] = coupling, inner_error
    found.sharpness[COUPLING] = coupling / 240.0**ORDER
    found.sharpness[INNER_STEPS] = inner_error / 60.0**4
    return found


@pytest.mark.parametrize("share", [0.3, 0.6, 0.9, 1.1, 3.0, 20.0])
def test_the_coupling_errs_with_its_power(share):
    """The largest rung up to 240 (1 / share)^(1/6), and not below 0.3 nor above 2 of the step."""
    wanted = 240.0 * share ** (-1.0 / ORDER)
    largest = max(rung for rung in RUNGS if rung <= wanted * (1.0 + 1e-12))
    assert RUNGS[next_rung(after_many(share * AIM, 0.0), HERE, DEGREE, True)] == largest


def test_inner_steps_of_one_length_err_alike_in_any_macro_step():
    """0.9 of what is aimed at, at 60 ticks: twice the macro step has twice as many of them."""
    found = after_many(1e-9 * AIM, 0.9 * AIM)
    assert [inner_steps(found, RUNGS.index(h), DEGREE, 1.0) for h in (240, 480)] == [1.0, 2.0]
    assert RUNGS[next_rung(found, HERE, DEGREE, True)] == 480


def test_rungs_whose_inner_steps_err_too_much_are_passed_over():
    """Of 240 and 400 ticks one and two from node to node: 60 and 50 ticks long; of 320 two of 40.

    At 60 ticks they err 1.5 of what is aimed at, at 50 0.72.
    """
    found = after_many(1e-9 * AIM, 1.5 * AIM)
    assert RUNGS[next_rung(found, HERE, DEGREE, True)] == 400


@pytest.mark.parametrize(
    ("coupling", "inner_error", "most", "count"),
    [
        (1e-9, 0.9, 2.0, 1.0),
        (1e-9, 0.9, 1.5, 2.0),
        (1e-9, 1.1, 2.0, 2.0),
        (0.3, 0.65, 2.0, 1.0),
        (0.3, 0.75, 2.0, 2.0),
        (0.8, 0.4, 2.0, 1.0),
        (0.8, 0.5, 2.0, 2.0),
    ],
)
def test_inner_steps_get_longer_where_the_tolerance_lets_them(coupling, inner_error, most, count):
    """From 240 to 480 ticks, 120 from node to node: one inner step there in place of two of 60.

    It errs 16 times as much, and the coupling 64 times, both given over what is aimed at: at most
    what the coupling leaves, or 0.45, unless it is not stable.
    """
    found = after_many(coupling / 2.0**ORDER * AIM, inner_error / 2.0**4 * AIM, most)
    rung = next_rung(found, HERE, DEGREE, True)
    choose_inner_steps(found, rung, DEGREE, True)
    times = 2.0 / count
    assert (RUNGS[rung], found.inner.times[TO_BE]) == (480, times)
    assert inner_steps(found, rung, DEGREE, times) == count
    choose_inner_steps(found, rung, DEGREE, False)
    assert found.inner.times[TO_BE] == 1.0


@pytest.mark.parametrize(("share", "held"), [(1.5, True), (1.7, False)])
def test_a_step_is_held_for_longer_than_it_would_be_taken(share, held):
    """Of 240 ticks, which err so many times what is aimed at; 192 is the rung below."""
    found = after_many(share * AIM, 0.0)
    assert RUNGS[next_rung(found, HERE, DEGREE, True)] < 240
    found = after_many(share * AIM, 0.0)
    found.state[WANTED] = HERE
    assert (RUNGS[next_rung(found, HERE, DEGREE, True)] == 240) is held


def test_a_jump_is_taken_back_sooner_than_what_grows():
    """More than six times what was expected is too much from 1.3 tolerances on, else from 4."""
    calm, lively = after_many(0.1 * TOLERANCE, 0.0), after_many(TOLERANCE, 0.0)
    assert [too_much(calm, HERE, e * TOLERANCE, DEGREE) for e in (1.2, 1.4)] == [False, True]
    assert [too_much(lively, HERE, e * TOLERANCE, DEGREE) for e in (1.4, 3.9, 4.1)] == [
        False, False, True,
    ]  # fmt: skip

"""Means of what pulsates with a shaft, of known answers; and no means of what does not."""

import numpy as np
import pytest

from herringbone.cosim.structure.approach import Approach, SteadyInput
from herringbone.running.settling.turn_means import (
    POINT,
    Shaft,
    means,
    shafts_of,
    turns_of,
)

SPEED, DURATION, MEAN = -105.0, 0.32, 40.0
"""Two turns and two thirds in the second half of the trial."""


def trial(answer, shaft, duration=DURATION):
    """Times of the second half at about `POINT`, and an answer (function of time and angle)."""
    times = np.linspace(-0.5 * duration, 0.0, int(0.5 * duration * abs(shaft.speed) / POINT))
    return times, np.array([answer(times, shaft.angles(times))]).T


@pytest.mark.parametrize("orders", [(6, 12), (24, 36), (12, 18)])
@pytest.mark.parametrize("acceleration", [0.0, 50.0])
def test_ripple(orders, acceleration):
    """The mean and half of the range. Points 1/480 of a turn apart in straight lines miss a period
    of an order k by (2 pi k / 480)^2 / 12 of the ripple, over the turn of its edges."""
    shaft = Shaft(SPEED, acceleration)

    def ripple(_, angle):
        return MEAN + 3.0 * np.cos(orders[0] * angle) + np.sin(orders[1] * angle + 0.3)

    found = means([shaft], *trial(ripple, shaft))
    missed = 4.0 * (2.0 * np.pi * orders[1] / 480.0) ** 2 / 12.0 / (2.0 * np.pi)
    assert found.last == pytest.approx([MEAN], abs=2.0 * missed)
    angle = np.linspace(0.0, 2.0 * np.pi, 10000)
    assert found.pulsation == pytest.approx(
        [0.5 * np.ptp(ripple(0.0, angle))], rel=2.0 * (np.pi * orders[1] / 480.0) ** 2
    )


def test_once_a_turn_wants_two_turns():
    shaft = Shaft(SPEED, 0.0)

    def unbalance(_, angle):
        return MEAN + np.sin(angle)

    assert means([shaft], *trial(unbalance, shaft)) is None
    found = means([shaft], *trial(unbalance, shaft, duration=0.64))
    assert found.last == pytest.approx([MEAN], abs=1e-4)


def test_a_mean_that_still_rises_is_told_at_the_end():
    """Its last value: half a period is made up for, as the slope of the two periods before."""
    shaft, rate = Shaft(SPEED, 0.0), 30.0
    found = means(
        [shaft], *trial(lambda t, angle: MEAN + rate * t + 3.0 * np.cos(12 * angle), shaft)
    )
    assert found.last == pytest.approx([MEAN], abs=1e-2 * rate * 2.0 * np.pi / abs(SPEED))


@pytest.mark.parametrize(
    "answer",
    [
        lambda t, _: MEAN + np.cos(19.5 * SPEED * t),
        lambda t, _: MEAN + np.exp(-20.0 * t),
        lambda t, _: np.random.default_rng(1).normal(size=len(t)),
    ],
    ids=["another frequency", "dying out", "noise"],
)
def test_what_does_not_repeat_with_the_turn(answer):
    shaft = Shaft(SPEED, 0.0)
    assert means([shaft], *trial(answer, shaft)) is None


def test_shafts_among_inputs():
    """One that tells its angle and its speed is one; what stands, and loads, are none."""
    inputs = (
        SteadyInput("phi", 0.2, SPEED, 3.0, None),
        SteadyInput("w", SPEED, 3.0, begin=0.0, moves=True),
        SteadyInput("w_out", 0.0, begin=0.0, moves=True),
        SteadyInput("torque_set", 120.0, begin=0.0),
    )
    shafts = shafts_of(Approach(inputs, DURATION, 1e-3))
    assert shafts == [Shaft(SPEED, 3.0)]
    assert turns_of(shafts, DURATION) == pytest.approx(0.08 * abs(SPEED) / (2.0 * np.pi))
    assert turns_of([], DURATION) == np.inf

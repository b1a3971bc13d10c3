"""What a part is given before the run: angles and speeds that belong together, up to the start."""

import numpy as np
import pytest

from herringbone.cosim.structure.approach import Approach, SteadyInput

SPEED, FASTER, DURATION = 10.0, 7.0, 0.4
INPUTS = (
    SteadyInput("phi", 3.0, SPEED, FASTER),
    SteadyInput("w", SPEED, FASTER, begin=0.0, moves=True),
    SteadyInput("f", 200.0, begin=5.0),
)


@pytest.mark.parametrize("gradual", [True, False])
def test_angle_is_the_integral_of_its_speed(gradual):
    given = Approach(INPUTS, DURATION, 1e-3, gradual=gradual)
    t = np.linspace(-DURATION, 0.0, 4001)
    phi, w, f = np.array([given.held(at, 0.0) for at in t]).T
    # Trapezoids err by the second derivative, at most 600 rad/s^3, times h^2 / 12 times T.
    turned = np.cumsum(0.5 * (w[1:] + w[:-1]) * np.diff(t))
    assert phi[1:] - phi[0] == pytest.approx(turned, abs=600.0 * 1e-8 / 12.0 * DURATION)
    assert given.turned(SPEED, FASTER) == pytest.approx(phi[-1] - phi[0], rel=1e-12)
    assert (phi[-1], w[-1], f[-1]) == pytest.approx((3.0, SPEED, 200.0), rel=1e-12)
    begin = 0.0 if gradual else SPEED - FASTER * DURATION
    assert (w[0], f[0]) == pytest.approx((begin, 5.0), abs=1e-12)


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_value_that_a_part_is_given_for_a_step(share):
    """An angle at its own place in the step, all else in the middle."""
    given = Approach(INPUTS, DURATION, 1e-3, share, gradual=False)
    phi, w, _ = given.held(-0.1, 0.02)
    at = -0.1 + 0.02 * share
    assert phi == pytest.approx(3.0 + SPEED * at + 0.5 * FASTER * at * at, rel=1e-12)
    assert w == pytest.approx(SPEED - 0.09 * FASTER, rel=1e-12)


@pytest.mark.parametrize("tapered", [True, False])
def test_steps_end_at_the_start_of_the_run(tapered):
    steps = list(Approach(INPUTS, DURATION, 0.3e-3, tapered=tapered).steps())
    ends = np.array([t + h for t, h in steps])
    assert steps[0][0] == -DURATION
    assert ends[:-1] == pytest.approx([t for t, _ in steps[1:]], abs=1e-12)
    assert ends[-1] == pytest.approx(0.0, abs=1e-15)
    assert max(h for _, h in steps) <= 0.3e-3
    # What is held over the last step is off by half of it: a thousandth of a whole one.
    assert (steps[-1][1] < 1e-3 * steps[0][1]) == tapered


@pytest.mark.parametrize("gradual", [True, False])
@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_steps_of_one_length(share, gradual):
    """All of that length, to the bit; what they begin earlier by, inputs stay as they begin."""
    step = 0.3e-3
    given = Approach(INPUTS, DURATION, step, share, gradual, tapered=False, even=True)
    rows = list(given.given())
    assert {h for _, h, _ in rows} == {step} and len(rows) == 1334
    assert [(t, h) for t, h, _ in rows] == list(given.steps())
    assert rows[0][0] == given.begin == pytest.approx(-1334 * step, rel=1e-12)
    assert rows[-1][0] == pytest.approx(-step, abs=1e-15)
    assert np.array([held for *_, held in rows]) == pytest.approx(
        np.array([given.held(t, h) for t, h, _ in rows]), rel=1e-12, abs=1e-12
    )
    free = Approach(INPUTS, DURATION, step, share, gradual, tapered=False)
    assert given.held(given.begin, 0.0) == pytest.approx(free.held(-DURATION, 0.0), abs=1e-12)
    assert given.held(-0.1, step) == pytest.approx(free.held(-0.1, step), abs=1e-12)


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_how_inputs_move_on_where_shafts_speed_up(share):
    """As in the motion before: an angle at its own place in the step, its derivatives at once."""
    onward = Approach(INPUTS, DURATION, 1e-3, share).onward
    at = 0.2 + 0.02 * share
    phi, w, f = onward.still + onward.moved(0.2, 0.02)
    assert phi == pytest.approx(3.0 + SPEED * at + 0.5 * FASTER * at * at, rel=1e-12)
    assert (w, f) == pytest.approx((SPEED + 0.21 * FASTER, 200.0), rel=1e-12)
    first, second, third = onward.derivatives(0.2, 3).reshape(3, 3)
    assert first == pytest.approx((SPEED + 0.2 * FASTER, FASTER, 0.0), rel=1e-12)
    assert second == pytest.approx((FASTER, 0.0, 0.0), rel=1e-12) and not third.any()
    assert onward.turning == (0,)


def test_shafts_that_hardly_speed_up_turn_on_evenly():
    """By less than a twentieth of their speed in half a second; from rest all that speeds up is
    much."""
    slow = 0.09 * SPEED

    def of(speed, acceleration):
        inputs = (
            SteadyInput("phi", 3.0, speed, acceleration),
            SteadyInput("w", speed, acceleration, begin=0.0, moves=True),
        )
        return Approach(inputs, DURATION, 1e-3).onward

    assert of(SPEED, slow).derivatives(0.2, 2) == pytest.approx((SPEED, 0.0, 0.0, 0.0), rel=1e-12)
    assert of(SPEED, 2.0 * slow).accelerations[0] == 2.0 * slow
    assert of(0.0, slow).accelerations[0] == slow

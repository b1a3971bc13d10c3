"""The rule of accuracy behind recommendations is what the published charts give."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from herringbone.analysis.accuracy.step_ladder import charted_algorithms
from herringbone.analysis.stability.recommendation import (
    CONTACT_ERROR,
    RULE_ERROR,
    SEPARATION_ERROR,
    rank,
)

PICTURES = Path(__file__).parents[4] / "examples" / "pictures"
FREQUENCY = 2.0 * np.pi * 2278.0
"""All bonds of the rig together [rad/s]: `herringbone stability test_rig`."""


PROMISE = 2.5
"""What is measured is at most so many times what is expected (docstring of `recommendation`)."""


def charted(scene, algorithm):
    """Logarithms of steps [s] and errors of the runs that were completed, by ascending step."""
    points = pd.read_csv(PICTURES / f"chart_{scene}.csv", comment="#")
    points = points[(points.algorithm == algorithm) & (points.outcome == "completed")]
    done = points.sort_values("step")
    error = done[["error_bearing_force", "error_seat_velocity"]].max(axis=1)
    return np.log(done.step.to_numpy()), np.log(error.to_numpy())


def largest_step(scene: str, algorithm: str) -> float:
    """Largest step [s] up to which every point is within the error, interpolated on logarithms."""
    step, error = charted(scene, algorithm)
    first = int(np.argmax(error > np.log(RULE_ERROR)))
    assert first > 0
    inside, outside = first - 1, first
    share = (np.log(RULE_ERROR) - error[inside]) / (error[outside] - error[inside])
    return float(np.exp(step[inside] + share * (step[outside] - step[inside])))


RANKED = [a for a in charted_algorithms() if a.accurate_step is not None]


@pytest.mark.parametrize("algorithm", RANKED, ids=str)
def test_rule_is_that_of_the_charts(algorithm):
    found = [FREQUENCY * largest_step(scene, str(algorithm)) for scene in ("loaded", "separation")]
    assert algorithm.accurate_step == pytest.approx(min(found), abs=6e-4)  # three decimals are kept


@pytest.mark.parametrize("algorithm", set(charted_algorithms()) - set(RANKED), ids=str)
def test_what_has_no_rule_is_not_that_accurate_in_the_charts(algorithm):
    for scene in ("loaded", "separation"):
        assert (charted(scene, str(algorithm))[1] > np.log(RULE_ERROR)).all()


@pytest.mark.parametrize("algorithm", RANKED, ids=str)
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8])
def test_charts_keep_what_is_expected(algorithm, tolerance):
    expected = rank([(algorithm, np.inf)], FREQUENCY, tolerance).best
    at = np.log(expected.step)
    for scene, promised in (
        ("loaded", expected.expected_error),
        ("separation", expected.separation_error),
    ):
        step, error = charted(scene, str(algorithm))
        if at >= step[0]:  # no smaller step was charted
            assert np.exp(np.interp(at, step, error)) < PROMISE * promised


def test_floor_is_where_smaller_steps_change_nothing():
    """li of degree 4 at 10 and 20 us: its nodes lie 2.5 and 5 us apart, the micro steps are equal.

    The floor is the larger one, rounded. Where teeth separate it is irregular: it goes with the
    places in the micro steps at which they part and meet.
    """
    for scene, floor, apart in (
        ("loaded", CONTACT_ERROR, 0.05),
        ("separation", SEPARATION_ERROR, PROMISE - 1.0),
    ):
        step, error = charted(scene, "li:degree=4,iterations=1")
        seen = [np.exp(error[np.argmin(np.abs(step - np.log(h)))]) for h in (10e-6, 20e-6)]
        assert max(seen) == pytest.approx(min(seen), rel=apart)
        assert floor == pytest.approx(max(seen), rel=0.05)

"""The rule of accuracy behind recommendations is what the published charts give."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from herringbone.analysis.recommendation import RULE_ERROR, STEP_RULE

PICTURES = Path(__file__).parents[2] / "examples" / "pictures"
FREQUENCY = 2.0 * np.pi * 2278.0
"""All bonds of the rig together [rad/s]: `herringbone stability test_rig`."""


def largest_step(points: pd.DataFrame) -> float:
    """Largest step [s] up to which every point is within the error, interpolated on logarithms."""
    done = points[points.outcome == "completed"].sort_values("step")
    step = np.log(done.step.to_numpy())
    error = np.log(done[["error_bearing_force", "error_seat_velocity"]].max(axis=1).to_numpy())
    first = int(np.argmax(error > np.log(RULE_ERROR)))
    assert first > 0
    inside, outside = first - 1, first
    share = (np.log(RULE_ERROR) - error[inside]) / (error[outside] - error[inside])
    return float(np.exp(step[inside] + share * (step[outside] - step[inside])))


@pytest.mark.parametrize("algorithm", STEP_RULE)
def test_rule_is_that_of_the_charts(algorithm):
    found = []
    for scene in ("loaded", "separation"):
        points = pd.read_csv(PICTURES / f"chart_{scene}.csv", comment="#")
        found.append(FREQUENCY * largest_step(points[points.algorithm == algorithm]))
    assert STEP_RULE[algorithm] == pytest.approx(min(found), abs=6e-4)  # three decimals are kept

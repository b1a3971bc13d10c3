"""Periods of records whose teeth nobody knows, and what is in doubt without one."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from support.result import make_foreign_result

from herringbone.analysis.steady.of_runs.repeating import repeating
from herringbone.analysis.steady.of_runs.settled import SettledState

TOLERANCE = 1e-3


def settled(period: float) -> SettledState:
    """A run of 1 s of two outputs that repeat, with five harmonics."""
    found = make_foreign_result()
    time = found.data["time"].to_numpy()
    angle = 2.0 * np.pi * time / period
    first, second = (
        3.0 + sum(np.cos(k * angle + shift * k) / k**2 for k in range(1, 6)) for shift in (0.3, 1.1)
    )
    data = pd.DataFrame({"time": time, "ball.h": first, "ball.v": first, "other.level": second})
    return SettledState(replace(found, data=data), TOLERANCE)


LEVEL = float(np.sqrt(0.5 * sum(k**-4.0 for k in range(1, 6))))


@pytest.mark.parametrize("period", [0.0317, 0.0703, 0.12])
def test_the_period_of_records_is_found(period):
    """No whole number of steps of 2 ms, nor of the last quarter, 250 ms."""
    state = settled(period)
    assert state.period == pytest.approx(period, rel=1e-4)  # a spline of 3 steps of a harmonic
    assert state.meshes == 0
    assert not state.ending.doubt
    assert state.error == max(state.changes.values())
    assert state.level("ball.v") == pytest.approx(LEVEL, rel=TOLERANCE)


def test_a_state_without_period_is_as_uncertain_as_its_window():
    """The last quarter holds 1.25 periods: the error that is told is above that of the levels."""
    state = settled(0.2)
    assert "no period was found" in state.notes[-2]
    off = abs(state.level("ball.v") / LEVEL - 1.0)
    assert off > 10.0 * TOLERANCE
    assert state.error > off
    assert not state.converged


def test_mesh_within_a_turn():
    """7 meshes of 1.11 ms repeat with a run-out only all together."""
    turn = 7.77e-3
    time = np.arange(2501) * 2e-5
    angle = 2.0 * np.pi * time / turn
    values = np.stack([np.cos(7 * angle) + 0.05 * np.cos(angle), np.sin(14 * angle)], axis=1)
    found = repeating(values, time, [[0], [1]], TOLERANCE)
    assert found[0] == pytest.approx(turn, rel=1e-6)


@pytest.mark.parametrize("value", [0.0, 1.0])
def test_what_stands_still_has_no_period(value):
    time = np.arange(101) * 1e-3
    assert repeating(np.full((101, 2), value), time, [[0, 1]], TOLERANCE) == []

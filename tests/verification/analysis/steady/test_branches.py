"""Branches over the speed: light teeth part at a resonance, where three motions are possible."""

import math

import numpy as np
import pytest

import herringbone as hb
from herringbone.analysis.steady.searching.remarks import FOLD
from herringbone.core import ParameterError

LIGHT = {"gear_mesh.symmetry_deviation": 0.0, "gear_mesh.mesh_damping_ratio": 0.002}
R_MIN = math.pi / 30.0
FIRST = hb.Point(speed=7100.0 * R_MIN, torque=20.0)
END = 7400.0 * R_MIN


@pytest.fixture(scope="module")
def solver():
    state = hb.steady("test_rig", speed=FIRST.speed, torque=FIRST.torque, values=LIGHT)
    return hb.SteadySolver(state.structure.system)


def test_a_branch_goes_around_two_folds_and_is_unstable_between_them(solver):
    """A real multiplier passes 1 at each: what lies between is left by a run, and by a sweep."""
    states = list(solver.branch(solver.solve(FIRST), END))
    assert all(state.converged for state in states)
    up, back = (k for k, state in enumerate(states) if FOLD in state.notes)
    grows = [state.multipliers.largest > 1.0 for state in states]
    assert grows == [up <= k < back for k in range(len(states))]
    speeds = np.array([state.speed for state in states])
    assert speeds[-1] >= END > speeds[:-1].max()
    assert (np.diff(speeds)[up : back - 1] < 0.0).all()
    # at 7170 r/min the branch passes three times, each time with larger forces
    crossed = np.flatnonzero(np.diff(np.sign(speeds - 7170.0 * R_MIN)))
    assert len(crossed) == 3
    levels = [states[k].level("bearing_force") for k in crossed]
    assert levels == sorted(levels)
    # both stable ones are what the solver finds from there, as fine as was asked
    for k in crossed[[0, 2]]:
        own = solver.solve(FIRST._replace(speed=states[k].speed), states[k])
        expected = own.level("bearing_force")
        assert states[k].level("bearing_force") == pytest.approx(expected, rel=2.0 * 1e-3)


def test_a_branch_without_folds_has_the_states_of_its_speeds(solver):
    """Nothing parts here: harmonics that are left out are 1e-6 of the alternating part."""
    first = FIRST._replace(speed=6000.0 * R_MIN)
    states = list(solver.branch(solver.solve(first), 5500.0 * R_MIN))
    assert not any(state.notes for state in states)
    for state in states:
        own = solver.solve(state.point).level("seat_velocity")
        assert state.level("seat_velocity") == pytest.approx(own, rel=1e-4)


@pytest.mark.parametrize(
    ("point", "speed", "message"),
    [
        (FIRST, -END, "branch: speed = -774.926 rad/s: it must be another one than that of"),
        (FIRST, FIRST.speed, "the state, 743.51 rad/s, and turn the same way"),
        (FIRST, math.nan, "speed = nan rad/s: it must be finite"),
        (FIRST._replace(speed=None), END, "branch: it begins at a speed that was asked for"),
        (FIRST._replace(torque=0.0), END, "branch: it begins at a state that was found"),
    ],
)
def test_branches_that_cannot_begin_are_refused_at_once(solver, point, speed, message):
    state = solver.solve(point)
    with pytest.raises(ParameterError, match=message):
        solver.branch(state, speed)


def test_a_speed_that_is_a_value_is_refused():
    """The system is taken apart anew for each of its values."""
    state = hb.steady("turbine", values={"gear_mesh.symmetry_deviation": 0.0})
    solver = hb.SteadySolver(state.structure.system)
    first = solver.solve(hb.Point(speed=state.speed))
    with pytest.raises(ParameterError, match="the speed of turbine is a value of its parts, over"):
        solver.branch(first, 1.1 * state.speed)

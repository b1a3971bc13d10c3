"""Shooting on the condensed core: the same motions as harmonic balance, and what it refuses."""

import json

import numpy as np
import pytest

import herringbone as hb
from herringbone.analysis.steady.marching.parting import parting
from herringbone.analysis.steady.operating_point import Point
from herringbone.analysis.steady.searching.search import Search
from herringbone.analysis.steady.solver import SteadySolver
from herringbone.commands.main import main
from herringbone.core import ParameterError
from herringbone.running.operating.steady import prepared_solver
from herringbone.running.prepared import Wishes

GROUPS = ("bearing_force", "seat_velocity")
STILL = {"gear_mesh.symmetry_deviation": 0.0}
TOLERANCE = 1e-4
POINT = Point(speed=1310.0 * np.pi / 30.0, torque=120.0)


def solver_of(solver: str, tolerance: float = TOLERANCE) -> SteadySolver:
    return prepared_solver(
        "test_rig", wishes=Wishes(values=STILL), tolerance=tolerance, solver=solver
    )[0]


@pytest.fixture(scope="module")
def balanced() -> hb.SteadyState:
    return solver_of("auto", 1e-5).solve(POINT)


@pytest.fixture(scope="module")
def shooter() -> SteadySolver:
    return solver_of("shooting")


def test_it_comes_to_what_harmonic_balance_does(balanced, shooter):
    state = shooter.solve(POINT)
    assert (balanced.solver, state.solver) == ("harmonic balance", "shooting")
    assert state.converged
    assert state.shot is not None
    assert state.shot.missed <= 0.1 * TOLERANCE
    times = np.arange(64) / 64 * state.period
    assert state.period == pytest.approx(balanced.period, rel=1e-9)
    for group in GROUPS:
        own, other = (each.signal(group, times) for each in (state, balanced))
        whole = np.linalg.norm(other - other.mean(axis=0))
        assert np.linalg.norm(own - other) < TOLERANCE * whole
        assert np.linalg.norm(own - other) < 2.0 * state.errors.left_out[group] * whole


def test_its_multipliers_are_those_of_the_linearised_motion(balanced, shooter):
    """Both are differences: of marches by 1e-4 of a swing, and of laws along the orbit."""
    found = shooter.solve(POINT).multipliers.values
    expected = balanced.multipliers.values
    for one in expected[:8]:
        assert np.abs(found - one).min() < 1e-4


def test_marches_beside_it_part_by_its_largest_multiplier(balanced, shooter):
    """The largest Lyapunov exponent of a periodic motion is the logarithm of that, per period."""
    state = shooter.solve(POINT)
    found = parting(state.structure, state.motion, state.shot.begin, state.period, 1)
    expected = np.log(balanced.multipliers.largest)
    assert expected < 0.0
    assert found.rate == pytest.approx(expected, abs=1e-3)  # norms of a pair swing: log 2 of 1024
    assert found.meets
    assert not found.parts


def test_a_neighbour_leads_on(shooter):
    """From a neighbour nothing is marched first, and the way is the same to the tolerance."""
    near = shooter.solve(POINT._replace(speed=POINT.speed * 0.999))
    ours, theirs = shooter.solve(POINT, near), shooter.solve(POINT)
    for group in GROUPS:
        assert ours.level(group) == pytest.approx(theirs.level(group), rel=TOLERANCE)


def test_where_harmonic_balance_fails_shooting_finds_the_motion(balanced, monkeypatch):
    monkeypatch.setattr(Search, "_resolved", lambda self, times, guess: None)
    state = solver_of("auto").solve(POINT)
    assert state.solver == "shooting"
    assert state.stable
    for group in GROUPS:
        assert state.level(group) == pytest.approx(balanced.level(group), rel=TOLERANCE)


def test_who_asks_is_told_what_has_found_a_state(tmp_path, capsys):
    asked = ["--set", "gear_mesh.symmetry_deviation=0", "--solver", "shooting"]
    assert main(["steady", "test_rig", *asked, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["solver"] == "shooting"
    assert found["missed"] <= 1e-4
    assert found["largest_multiplier"] < 1.0
    folder = tmp_path / "sweep"
    assert main(["sweep", "test_rig", *asked, "--speed", "1000,1010", "-o", str(folder)]) == 0
    assert (folder / "table.csv").read_text().count("found by shooting") == 2
    assert main(["sweep", "test_rig", *asked, "--speed", "1000", "--transient"]) == 2
    assert "--solver: of steady states" in capsys.readouterr().err


def test_what_it_cannot_do_is_refused():
    with pytest.raises(ParameterError, match=r"gearbox: solver = shooting: nothing holds the spee"):
        hb.steady("gearbox", values=STILL, speed=100.0, solver="shooting")
    without = r"solver = shooting: torque = 0 N m: .* ask for a load, or leave the solver"
    with pytest.raises(ParameterError, match=without):
        hb.steady("test_rig", values=STILL, torque=0.0, solver="shooting")
    with pytest.raises(ParameterError, match=r"solver = newton: there are auto, shooting"):
        hb.steady("test_rig", values=STILL, solver="newton")

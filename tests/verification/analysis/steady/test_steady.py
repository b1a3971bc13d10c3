"""Steady states by harmonic balance against the fused core that marches on from them."""

import math
import pickle
from itertools import pairwise

import numpy as np
import pytest
from support.gearing.own_pair import write_pair
from support.steady import STILL
from threadpoolctl import threadpool_limits

import herringbone as hb
from herringbone.analysis.steady.harmonic_balance.balance import Balance
from herringbone.analysis.steady.marching.marched import Following, start_of
from herringbone.analysis.steady.operating_point import Point
from herringbone.analysis.twin.condensed.solution import Solution
from herringbone.analysis.twin.fused.core import Steps
from herringbone.components.law_addresses import law_address, signals_address
from herringbone.running.operating.steady import prepared_solver
from herringbone.running.prepared import Wishes

GROUPS = ("bearing_force", "seat_velocity")
PERIODS, PER_PERIOD, STEP = 40, 64, 5e-6


def marched(
    state: hb.SteadyState, columns: list[str], periods: int
) -> tuple[np.ndarray, np.ndarray]:
    """Times and values of the last of some periods, from the state on."""
    steps = Steps(STEP, 4, 1e-9, lean=False)
    core, orbit = state.structure.core, state.orbit
    run = core.solution(steps)
    own = start_of(orbit)
    run.state.q[: own.size] = own
    outputs = core.outputs(columns, steps, inside=False)
    places = PER_PERIOD * state.meshes
    gap = state.period / places
    step = gap / np.ceil(gap / STEP)
    times = (np.arange(places) + (periods - 1) * places) * gap
    end = round(periods * state.period / step) * step
    with threadpool_limits(limits=1, user_api="blas"):
        values = [outputs.values(run, part) for part in run.piece(0.0, end, step, times)]
    return times, np.concatenate(values)


def error(state: hb.SteadyState, group: str, periods: int = PERIODS) -> float:
    """What a march differs by after some periods, over the alternating part of a group."""
    columns = state.chosen(group)
    times, values = marched(state, columns, periods)
    expected = state.signal(group, times)
    alternating = expected - expected.mean(axis=0)
    return float(np.linalg.norm(values - expected) / np.linalg.norm(alternating))


GOVERNED = {"nominal_speed": 300.0, "constant_share": 50.0, "linear_share": -50.0}


@pytest.mark.parametrize(("governed", "torque"), [({}, 40.0), (GOVERNED, 0.0)])
def test_a_march_stays_on_the_state_beside_a_freewheel(governed, torque):
    """A second machine drives along, or has a speed of its own, at which its torque is zero.

    The march is long: torque ripple comes in at its start, and 4 % of that die out in a period.
    """
    values = {f"booster_machine.{name}": value for name, value in governed.items()}
    state = hb.steady("boosted_axle", values=values)
    rotor, booster = state.mean("axle.rotor.flange_a.w"), state.mean("booster.flange_a.w")
    assert state.converged
    assert booster == pytest.approx(300.0 if governed else rotor, rel=1e-9)
    assert state.slips == ({"booster.angle": pytest.approx(300.0 - rotor)} if governed else {})
    assert state.harmonics(["booster.flange_a.phi"]).slope == pytest.approx(booster, rel=1e-9)
    assert state.mean("freewheel.torque") == pytest.approx(torque, rel=1e-6, abs=1e-6)
    for group in GROUPS:
        assert error(state, group, 100) < state.tolerance


@pytest.mark.parametrize("tolerance", [1e-3, 1e-4])
def test_a_march_stays_on_the_state(tolerance):
    """The stated error is of single harmonics in all channels: the march differs by no more."""
    state = hb.steady("test_rig", values=STILL, tolerance=tolerance)
    assert state.converged
    assert state.meshes == 1
    for group in GROUPS:
        assert error(state, group) < tolerance
        assert error(state, group) < 2.0 * state.errors.left_out[group] + 1e-5  # the march's own


def test_the_worst_channel_is_told():
    """Over its own alternating part, where that of the group hides it."""
    coarse, fine = (hb.steady("test_rig", values=STILL, tolerance=t) for t in (1e-3, 1e-6))
    times, off = np.arange(256) / 256 * fine.period, {}
    for column in (c for group in GROUPS for c in coarse.chosen(group)):
        own, other = (state.signal(column, times) for state in (coarse, fine))
        whole = np.linalg.norm(other - other.mean())
        if whole > 1e-9 * np.linalg.norm(other):
            off[column] = np.linalg.norm(own - own.mean() - other + other.mean()) / whole
    name, error = coarse.worst_channel
    assert error == pytest.approx(max(off.values()), rel=0.2)
    assert error == pytest.approx(off[name], rel=0.2)
    assert error > 2.0 * coarse.error


def test_set_points_are_addressed(solver):
    state = solver.solve(Point(speed=2945.0 * np.pi / 30.0, torque=150.0))
    assert state.speed == pytest.approx(2945.0 * np.pi / 30.0, rel=1e-9)
    # Losses of the meshes are all that the drive gives besides; 200 N m would be 33 % off.
    assert state.mean("drive_motor.torque") == pytest.approx(150.0, rel=1e-3)


def test_neighbours_lead_to_the_same_state(solver):
    """Newton's last correction is far below the tolerance: its square is what is left."""
    near = solver.solve(Point(speed=100.0))
    ours, theirs = solver.solve(Point(speed=105.0), near), solver.solve(Point(speed=105.0))
    for group in GROUPS:
        assert ours.level(group) == pytest.approx(theirs.level(group), rel=1e-4)


def test_laws_along_a_state_are_its_own(solver):
    """Whatever is solved after it: its bends, multipliers and sensitivities come from them."""
    state = solver.solve(Point(speed=100.0))
    before = state.orbit.samples.f.copy()
    other = solver.solve(Point(speed=105.0))
    assert other.orbit.places == state.orbit.places
    assert np.array_equal(state.orbit.samples.f, before)
    assert not np.array_equal(other.orbit.samples.f, before)


def test_halved_steps_of_a_march_meet_knots_as_before(solver, monkeypatch):
    """Marches by 1, 2, 4, 8 steps of a place; by 7, errors of what bends came anew, and larger."""
    lengths, piece = [], Solution.piece

    def told(self, begin, end, step, times):
        lengths.append(step)
        return piece(self, begin, end, step, times)

    state = solver.solve(Point(speed=192.0))
    way = Following(state.structure, state.motion, state.orbit, places=16)
    monkeypatch.setattr(Solution, "piece", told)
    for _ in range(4):
        way.on(16, 1)
        way.halve()
    gap = state.period / 16
    assert 70e-6 < gap < 80e-6
    assert lengths == pytest.approx([gap, gap / 2, gap / 4, gap / 8], rel=1e-6)


def test_halved_steps_of_a_march_tighten_its_residuals(solver):
    """Laws are solved to 1e-3 in every step, from what the last one foretells.

    That is so much nearer in half the step that what is left falls with what steps err by: halving
    tells both, and more than is left then.
    """
    state, periods = solver.solve(Point(speed=200.0, torque=10.0)), 8

    def values(halvings: int) -> np.ndarray:
        way = Following(state.structure, state.motion, state.orbit, places=16)
        for _ in range(halvings):
            way.halve()
        return way.on(16 * periods, 16 * periods).values

    def off(one: np.ndarray, other: np.ndarray) -> float:
        whole = other - other.mean(axis=1, keepdims=True)
        return float(np.linalg.norm(one - other) / np.linalg.norm(whole))

    *coarse, exact = (values(halvings) for halvings in range(7))
    left = [off(one, exact) for one in coarse]
    told = [off(one, before) for before, one in pairwise(coarse)]
    assert left[0] > 1e-3
    assert all(own < 0.5 * change for own, change in zip(left[1:], told, strict=True))
    assert left[-1] < 1e-7


def test_an_iteration_that_ran_away_is_no_state(solver, monkeypatch):
    """With 4 um of transmission error at 3317.51 r/min and 10 N m it came to rest at 3e35 rad/s."""
    solve = Balance.solve

    def away(self, values, known, close):
        found = solve(self, values, known, close)
        return found._replace(response=self._response(2.86e35, found.response.orders))

    monkeypatch.setattr(Balance, "solve", away)
    state = solver.solve(Point(speed=100.0))
    assert not state.found
    assert not state.converged
    assert state.notes


def test_run_outs_make_the_period_long():
    """27 and 81 teeth: 81 meshes; a march over two of these periods stays on the state."""
    state = hb.steady("test_rig", tolerance=1e-3)
    assert state.converged
    assert state.meshes == 81
    assert state.period == pytest.approx(3.0 * 0.06, rel=1e-9)  # three turns of the pinion
    for group in GROUPS:
        assert error(state, group, periods=2) < 1e-3


def test_teeth_that_deviate_make_the_period_long(tmp_path):
    """20 and 30 teeth of class 7, which open a mesh at rest: a march stays on the state."""
    gear = tmp_path / "pair.toml"
    text = write_pair(gear).read_text().replace("[23, 57]", "[20, 30]")
    gear.write_text(text + "[deviations]\ngrade = 7\nseed = 1\n")
    speed, values = 1000.0 * np.pi / 30.0, {**STILL, "gear_mesh.ramp_turns": 0.0}
    state = hb.steady("test_rig", values=values, gear=gear, speed=speed, tolerance=1e-4)
    assert state.converged
    assert state.meshes == 60
    for group in GROUPS:
        assert error(state, group, periods=2) < 1e-4
    # Once per turn of the pinion: pitch errors, which ideal teeth do not have.
    orders = dict(zip(state.orders, np.abs(state.amplitudes("pinion_left.f_y")[0]), strict=True))
    assert orders[1.0] > 1.0


def test_a_state_is_drawn():
    state = hb.steady("gearbox", values=STILL, speed=100.0)
    figure = state.plot()
    rows = len(state.channels)
    assert len(figure.axes) == 2 * (rows + 1)
    signal, orders = figure.axes[0].lines[0], figure.axes[1].lines[0]
    assert signal.get_xdata()[-1] == state.meshes == 1
    drawn = np.asarray(orders.get_ydata())
    pooled = np.sqrt(np.mean(np.abs(state.amplitudes("bearing_force")[:, 1:]) ** 2, axis=0))
    assert drawn.max() == pytest.approx(pooled.max())
    assert "stable" in figure.axes[2 * rows].get_title(loc="left")


def test_signals_that_coincide_are_told_beside_the_curves():
    figure = hb.steady("gearbox", values=STILL, speed=100.0).plot()
    figure.canvas.draw()
    told = [
        (axes, axes.texts[0]) for axes in figure.axes if axes.texts and axes.texts[0].get_text()
    ]
    assert told
    for axes, text in told:
        lowest = min(float(np.min(line.get_ydata())) for line in axes.lines)
        assert text.get_window_extent().y1 < axes.transData.transform((0.0, lowest))[1]
        assert [line.get_linestyle() for line in axes.lines] == ["-", "--"] * 2


def test_a_line_through_two_neighbours_leads_on():
    """Its error falls with the square of the way, that of the last one alone with the way."""
    solver, _ = prepared_solver("test_rig", wishes=Wishes(values=STILL), tolerance=1e-6)
    off = []
    for way in (5e-4, 2.5e-4):
        points = [Point(speed=(1.0 + k * way) * 1310.0 * math.pi / 30.0) for k in range(3)]
        near = solver.solve(points[1], solver.solve(points[0])).neighbour
        exact = solver.solve(points[2], near).neighbour.guess.values
        guesses = near.towards(points[2]), near.guess
        off.append([np.linalg.norm((guess.values - exact)[:, 1:]) for guess in guesses])
    (along, still), (nearer_along, nearer_still) = off
    assert along / nearer_along == pytest.approx(4.0, rel=0.2)
    assert still / nearer_still == pytest.approx(2.0, rel=0.1)
    for elsewhere in (points[2]._replace(torque=100.0), Point(speed=2.0 * points[2].speed)):
        assert near.towards(elsewhere) is near.guess


def test_along_a_line_a_neighbour_takes_fewer_iterations(solver):
    points = [Point(speed=(1.0 + k * 1e-3) * 1310.0 * math.pi / 30.0) for k in range(3)]
    near = solver.solve(points[1], solver.solve(points[0])).neighbour
    one, other = (solver.solve(points[2], n) for n in (near, near._replace(before=None)))
    assert one.orbit.iterations < other.orbit.iterations


def test_a_pickled_state_holds_nothing_of_this_process():
    """Elsewhere addresses of compiled laws point nowhere; `multipliers` ended the process there."""
    state = hb.steady("gearbox", tolerance=1e-2)
    known = state.harmonics(state.columns).coefficients
    sent = pickle.dumps(state)
    for address in (law_address("gear_mesh"), signals_address("bearing_supports")):
        assert address.to_bytes(8, "little") not in sent
    again = pickle.loads(sent)
    assert again.multipliers.largest == state.multipliers.largest
    assert np.array_equal(again.harmonics(state.columns).coefficients, known)

"""Steady states under torques that the coast flank carries, against runs and balances of torque."""

import numpy as np
import pytest

import herringbone as hb
from herringbone.analysis.steady.harmonic_balance.accuracy import accuracy
from herringbone.analysis.steady.harmonic_balance.balance import Balance
from herringbone.analysis.steady.solver import SteadySolver

EVEN = {"gear_mesh.symmetry_deviation": 0.0}
FORCE = "gearbox.bearing_supports.shaft.pinion_left.f_y"
RATIO = 3.0


@pytest.mark.parametrize("torque", [-20.0, -150.0])
def test_it_is_what_a_run_settles_to(torque):
    """Runs err up to 1e-3 of the alternating part of the group, and this force is half of that."""
    state = hb.steady("test_rig", torque=torque, values=EVEN)
    assert state.converged
    assert "the coast flank carries" in " ".join(state.notes)
    run = hb.run("test_rig", torque=torque, values=EVEN, t_end=0.4, fmu="in-process")
    rows = run.data["time"] > 0.3
    mean, *alternating = state.harmonics([FORCE]).coefficients[0]
    assert run.data[FORCE][rows].mean() == pytest.approx(mean.real, rel=1e-4)
    rms = np.sqrt(2.0 * np.sum(np.square(np.abs(alternating))))
    assert run.data[FORCE][rows].std() == pytest.approx(rms, rel=5e-3)


def test_torques_balance():
    """Mean torques follow from the ratio alone; meshes give back what they take over a period."""
    state = hb.steady("test_rig", torque=-20.0, values=EVEN)
    columns = ["drive_coupling.torque", "load_coupling.torque"]
    means = state.harmonics(columns).coefficients[:, 0].real
    assert means == pytest.approx([-20.0, -20.0 * RATIO], rel=1e-3)
    assert state.speed == pytest.approx(1000.0 * np.pi / 30.0, rel=1e-9)


def test_what_was_prepared_for_the_other_flank_is_refused():
    prepared = SteadySolver(hb.steady("test_rig", values=EVEN).structure.system)
    for torque in (-20.0, -150.0):
        state = prepared.solve(hb.Point(torque=torque))
        assert not state.found
        assert state.notes == (
            "test_rig was prepared for the other flank of gearbox.gear_mesh, and its line of "
            "action: prepare it at this point, as 'steady' does",
        )
    assert prepared.solve(hb.Point(torque=20.0)).converged


def test_sweeps_go_through_zero():
    torques = [-150.0, -20.0, 20.0, 150.0]
    found = hb.sweep("test_rig", torque=torques, values=EVEN, workers=1)
    assert set(found.table["outcome"]) == {"steady"}
    for torque, rms in zip(torques, found.table["bearing_force.rms"], strict=True):
        own = hb.steady("test_rig", torque=torque, values=EVEN)
        assert rms == pytest.approx(np.sqrt(np.mean(_squares(own))), rel=1e-3)


def test_sweeps_over_a_value_that_reverses_the_torque_have_the_states_of_their_points():
    """The first on each flank to the last bit; the last one within the tolerance of both."""
    loads = [-1.0, 0.2, 1.0]
    found = hb.sweep("e_axle", vary={"road.constant_share": loads}, workers=1)
    assert found.table["outcome"].tolist() == ["steady"] * 3
    for load, rms, off in zip(
        loads, found.table["bearing_force.rms"], (1e-12, 1e-12, 2e-3), strict=True
    ):
        own = hb.steady("e_axle", values={"road.constant_share": load})
        assert rms == pytest.approx(np.sqrt(np.mean(_squares(own))), rel=off)


def _squares(state):
    amplitudes = state.amplitudes("bearing_force")
    return 0.5 * np.sum(np.square(np.abs(amplitudes[:, 1:])), axis=1)


def test_nothing_that_does_not_balance_has_converged():
    """Teeth that are open at the guess alternate nowhere: a step of Newton from there is none."""
    state = hb.steady("test_rig", values=EVEN)
    structure, resolved = state.structure, state.orbit.resolved
    balance = Balance(structure.problem, resolved, state.motion)
    opened = np.zeros_like(state.orbit.channels[: structure.problem.values])
    tried = balance.solve(opened, state.orbit.response.orders, 1e-6)
    left = balance.lacking(tried.channels, tried.response.orders)[0].residual
    assert not tried.converged or left < 1e-6
    standing = balance.along(opened, state.orbit.response.orders)
    errors = accuracy(structure, resolved, state.motion, standing)
    assert errors.worst > 0.1

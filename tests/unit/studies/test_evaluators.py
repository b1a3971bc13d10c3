"""What stands in the row of a point, of runs and of steady states."""

import math

import numpy as np
import pytest
from support.studies import Cheap

import herringbone as hb
from herringbone.analysis.steady.searching.remarks import GROWS
from herringbone.analysis.steady.solver import SteadySolver
from herringbone.analysis.steady.state import SteadyState
from herringbone.core import ParameterError
from herringbone.studies.evaluators import steady
from herringbone.studies.evaluators.levels import moments, order_amplitudes, order_figures

AMPLITUDES = {1: 3.0, 3: 5.0, 4: 0.5}
"""Of mesh orders, of the first channel; the second one has the half of them."""


def signals(turn: np.ndarray) -> np.ndarray:
    one = sum(a * np.sin(2.0 * np.pi * k * turn + k) for k, a in AMPLITUDES.items())
    return np.column_stack([10.0 + one, -20.0 + 0.5 * one])


def test_moments_of_known_signals():
    found = moments(signals(np.arange(1000) / 100.0))
    square = 0.5 * sum(a * a for a in AMPLITUDES.values())
    assert found["rms"] == pytest.approx(math.sqrt(square * (1.0 + 0.25) / 2.0), rel=1e-12)
    assert found["mean"] == pytest.approx(math.sqrt((100.0 + 400.0) / 2.0), rel=1e-12)


def test_orders_of_known_signals():
    """Side lobes of a Hann window fall by 18 dB an octave: below 1e-4 forty bins away."""
    time = np.linspace(0.0, 0.1, 5001)
    found = order_amplitudes(time, signals(437.3 * time), 437.3)
    pooled = math.sqrt((1.0 + 0.25) / 2.0)
    for k in range(1, 9):
        assert found[k - 1] == pytest.approx(pooled * AMPLITUDES.get(k, 0.0), abs=5e-4)
    figures = order_figures("x", np.arange(1.0, found.size + 1.0), found, "N")
    assert [figures[f"x.largest_{k}"].value for k in (1, 2, 3)] == [3.0, 1.0, 4.0]
    assert figures["x.order_3"].value == found[2] == figures["x.largest_1_amplitude"].value
    assert order_amplitudes(time[:200], signals(437.3 * time[:200]), 437.3).size == 0


def test_moments_of_harmonics_are_those_of_the_signal():
    """The largest of 4 points per harmonic lies below the peak by less than (pi / 4)^2 / 2."""
    turn = np.arange(4000) / 4000.0
    values = signals(turn)
    amplitudes = np.fft.rfft(values, axis=0).T[:, :33] / 4000.0
    amplitudes[:, 1:] *= 2.0
    found, known = steady._moments(amplitudes, np.arange(amplitudes.shape[1])), moments(values)
    assert found["rms"] == pytest.approx(known["rms"], rel=1e-12)
    assert found["mean"] == pytest.approx(known["mean"], rel=1e-12)
    assert 0.99 * known["peak"] < found["peak"] <= known["peak"] * (1.0 + 1e-12)


def test_the_peak_of_harmonics_with_gaps_between_is_that_of_the_signal():
    """sin 23 x + sin 1633 x nearly reaches 2; sin x + sin 2 x, side by side, has 1.76."""
    amplitudes = np.array([[7.0, -1.0j, -1.0j]])
    x = 2.0 * np.pi * np.arange(200_000) / 200_000
    known = np.abs(np.sin(23.0 * x) + np.sin(1633.0 * x)).max()
    found = steady._moments(amplitudes, np.array([0, 23, 1633]))
    assert found["peak"] == pytest.approx(known, rel=1e-3)


def test_a_steady_sweep_has_the_states_of_its_points():
    """The first one to the last bit; its neighbour within the tolerance of both."""
    speeds = [100.0, 103.0]
    found = hb.sweep("gearbox", speed=speeds, torque=[150.0], workers=1)
    assert found.table["outcome"].tolist() == ["steady", "steady"]
    assert found.units["speed"] == "rad/s"
    assert found.units["bearing_force.rms"] == "N"
    levels = found.table["bearing_force.rms"]
    for k, exact in ((0, True), (1, False)):
        state = hb.steady("gearbox", speed=speeds[k], torque=150.0)
        tolerance = 0.0 if exact else 2e-3
        assert levels[k] == pytest.approx(state.level("bearing_force"), rel=tolerance, abs=0.0)
        teeth = 27.0 * speeds[k] / (2.0 * math.pi)
        assert found.table["mesh_frequency"][k] == pytest.approx(teeth, rel=1e-9)


def test_runs_have_rows_over_time_on_request(tmp_path):
    wanted = {"speed": [100.0], "torque": [150.0], "t_end": 1e-2, "output": tmp_path}
    with pytest.raises(ParameterError, match=r"series: of runs.*hb\.Transient"):
        hb.sweep("gearbox", evaluator=hb.Steady(), series=True, **wanted)
    with pytest.raises(ParameterError, match="t_end: of runs"):
        hb.sweep("gearbox", **wanted)
    with pytest.raises(ParameterError, match="t_end, start: of runs"):
        hb.sweep("gearbox", evaluator=hb.Steady(tolerance=0.01), start="ramp", **wanted)
    found = hb.sweep("gearbox", evaluator=hb.Transient(), series=True, workers=1, **wanted)
    (folder,) = (tmp_path / "series").iterdir()
    result = hb.load(folder)
    assert result.outcome.completed
    assert result.data["time"].iloc[-1] == pytest.approx(1e-2)
    assert found.table["outcome"].tolist() == ["completed"]
    assert found.table["radiated_power"].tolist() == [hb.radiated_power(result).level_db]


def test_dask_gives_the_same_bits():
    distributed = pytest.importorskip("distributed", reason="the extra cluster is not installed")
    wanted = {"speed": [100.0, 200.0], "torque": [1.0, 2.0], "evaluator": Cheap()}
    with (
        distributed.LocalCluster(
            n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        found = hb.sweep("gearbox", executor=client.get_executor(), **wanted)
    assert found.table.equals(hb.sweep("gearbox", workers=1, **wanted).table)


def test_what_is_no_motion_has_no_figures():
    """The drive gives less than 1e5 N m; at 1e8 rad/s 27 teeth mesh 4e8 times a second."""
    table = hb.sweep("test_rig", speed=[300.0, 100.0, 1e8], torque=[1e5], workers=1).table
    assert table["outcome"].tolist() == ["not_converged", "not_converged", "failed"]
    assert table["message"].str.contains("no steady rotation").tolist() == [True, True, False]
    assert "at most 2.327e+05 rad/s" in table["message"][2]
    assert list(table.columns) == ["point", "torque", "speed", "outcome", "message"]


def test_a_motion_that_a_run_would_leave_is_no_steady_point():
    """Ripple of the motor at both mesh orders parts light teeth: a multiplier of 2.4 at 300 N m."""
    values = {
        "machine.order_1.order": 27.0,
        "machine.order_2.order": 54.0,
        "rotor.inertia": 0.002,
        "gearbox.gear_mesh.mesh_damping_ratio": 0.01,
        "road.constant_share": 0.1,
    }
    ripple = "machine.order_1.amplitude"
    found = hb.sweep("e_axle", vary={ripple: [100.0, 300.0]}, values=values, workers=1)
    assert found.table["outcome"].tolist() == ["steady", "unstable"]
    settled, left = found.table["message"]
    assert not settled
    assert left.startswith("unstable: small deviations grow")
    assert "laws bend within the period: gearbox.gear_mesh" in left
    levels = found.table["bearing_force.rms"]
    assert levels[0] == pytest.approx(53.2, rel=1e-2)
    assert math.isnan(levels[1])


def test_shooting_that_follows_a_branch_keeps_its_figures_where_a_run_would_leave_it(monkeypatch):
    solve = SteadySolver.solve
    monkeypatch.setattr(SteadySolver, "solve", lambda *given: solve(*given).noted([GROWS]))
    even = {"gear_mesh.symmetry_deviation": 0.0}
    for solver, has_figures in (("auto", False), ("shooting", True)):
        asked = hb.Steady(solver=solver)
        found = hb.sweep("test_rig", speed=[100.0], values=even, evaluator=asked, workers=1).table
        assert found["outcome"].tolist() == ["unstable"]
        assert ("bearing_force.rms" in found) == has_figures


def test_a_point_tells_why_it_is_not_as_fine_as_asked_and_after_what_it_repeats(monkeypatch):
    solve = SteadySolver.solve
    notes = ("subharmonic: it repeats after 2 periods",)
    monkeypatch.setattr(SteadySolver, "solve", lambda *given: solve(*given).noted(notes))
    wanted = {"speed": [100.0], "torque": [150.0], "workers": 1}
    assert hb.sweep("gearbox", **wanted).table["message"].tolist() == list(notes)
    monkeypatch.setattr(SteadyState, "converged", False)
    told = hb.sweep("gearbox", **wanted).table
    assert told["outcome"].tolist() == ["not_converged"]
    assert told["message"][0].endswith(f"0.001 was asked for; {notes[0]}")

"""Bodies with direct compliance on elements: the loop gain decides, not the macro step.

Two free masses and a spring of stiffness K between them; one mass gives way directly by D times its
force. The loop gain is K D; the motion is that of two masses and a spring K / (1 + K D).
"""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from support.parts.running import columns
from support.parts.two_masses import MOTION, TWO_MASS_SYSTEM, ResidualMass, TwoMass

from herringbone.commands.main import main
from herringbone.components.bearing_supports import BEARING_SUPPORTS
from herringbone.core import OutcomeKind, ParameterError
from herringbone.cosim.algebraic_loop import extrapolated_growth, measure_loop, solved_growth
from herringbone.cosim.algorithms import LI, FixedPoint, GaussSeidel, Jacobi, Predict
from herringbone.cosim.algorithms.staged import Prepared
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.network import build_network

RESIDUAL_HOUSING = Path(__file__).parents[2] / "fmus" / "residual_housing.py"
PROBLEM = TwoMass(w=1.0, start=(1.0, 0.0))
STEPS = 2e-1, 2e-2, 2e-3
LIMITS = {0: 1.0, 1: 1.0 / 3.0, 2: 1.0 / 7.0}
"""1 / (2^(order + 1) - 1)."""


def parts(gain, **more):
    """New participants with a loop gain; the force at the start agrees with the motion."""
    return PROBLEM.parts(kind=ResidualMass, compliance=gain / PROBLEM.stiffness, **more)


def run(algorithm, gain, h, count=100, **more):
    return simulate(TWO_MASS_SYSTEM, parts(gain, **more), algorithm, make_grid(count * h, h, h))


def without_prediction(monkeypatch):
    """Let a run go on that is known to diverge."""
    for kind in (Prepared, type(FixedPoint().prepare(build_network(TWO_MASS_SYSTEM, parts(0.5))))):
        predict = kind.close_loop
        monkeypatch.setattr(
            kind, "close_loop", lambda self, loop, own=predict: min(own(self, loop), 0.5)
        )


def jump(recording):
    """Largest change of the left mass' velocity in a step, over that of the first."""
    change = np.abs(np.diff(columns(recording, ["left.flange.v"])[:, 0]))
    return change.max() / change[0]


@pytest.mark.parametrize("gain", [0.9, 1.05])
def test_gain_is_measured_through_set_and_get(gain):
    found = measure_loop(build_network(TWO_MASS_SYSTEM, parts(gain)))
    assert found.gain == pytest.approx(gain, rel=1e-9)
    assert found.culprit == "left.flange.f"
    assert found.compliance == pytest.approx([gain / PROBLEM.stiffness], rel=1e-9)


def test_no_loop_without_direct_compliance():
    assert measure_loop(build_network(TWO_MASS_SYSTEM, PROBLEM.parts())) is None


@pytest.mark.parametrize("h", STEPS)
@pytest.mark.parametrize("algorithm", [Jacobi(0), FixedPoint()], ids=str)
def test_gain_beyond_one_diverges_at_every_step(algorithm, h, monkeypatch):
    """It is stopped before the run; let go, it grows beyond all bounds."""
    assert run(algorithm, 1.05, h).outcome.kind is OutcomeKind.COUPLING_FAILED
    without_prediction(monkeypatch)
    assert run(algorithm, 1.05, h, count=2000).outcome.kind is OutcomeKind.DIVERGED


def test_forces_grow_by_the_gain(monkeypatch):
    """Held forces, 500 steps so short that the masses hardly move."""
    without_prediction(monkeypatch)
    recording = run(Jacobi(0), 1.05, 1e-5, count=500)
    force = np.abs(np.diff(columns(recording, ["spring.a.f"])[:, 0]))
    assert force[-1] / force[-101] == pytest.approx(1.05**100, rel=1e-3)


@pytest.mark.parametrize("order", LIMITS)
@pytest.mark.parametrize("h", STEPS[1:])
def test_jacobi_changes_sides_at_its_limit(order, h, monkeypatch):
    """Growth as predicted 5 % above the limit, decay 10 % below it; both ten thousand-fold."""
    above, below = 1.05 * LIMITS[order], 0.9 * LIMITS[order]
    assert run(Jacobi(order), above, h).outcome.kind is OutcomeKind.COUPLING_FAILED
    assert run(Jacobi(order), below, h, count=1000).outcome.completed
    assert jump(run(Jacobi(order), below, h, count=1000)) < 2.0
    without_prediction(monkeypatch)
    assert not run(Jacobi(order), above, h, count=3000).outcome.reached_end


@pytest.mark.parametrize("order", LIMITS)
def test_growth_is_one_at_the_limit(order):
    growth = extrapolated_growth(np.array([[-LIMITS[order]]]), [order], 0)
    assert growth == pytest.approx(1.0, rel=1e-9)


@pytest.mark.parametrize(
    ("algorithm", "gain", "tolerance"),
    [(FixedPoint(), 0.9, 1e-4), (LI(), 0.9, 1e-4), (LI(), 1.05, 1e-4), (LI(), 20.0, 1e-4)],
    ids=str,
)
def test_solved_loop_moves_like_springs_in_series(algorithm, gain, tolerance):
    recording = run(algorithm, gain, 0.1)
    assert recording.outcome.completed
    assert any(f"gain of {gain:.3g}" in note for note in recording.notes)
    series = SeriesTwoMass(gain).exact(recording.time)
    found = columns(recording, MOTION)[:, 1::2]
    assert np.abs(found - series[:, 1::2]).max() < tolerance * np.abs(series[:, 1::2]).max()


class SeriesTwoMass(TwoMass):
    """The two masses with the compliance in series with the spring."""

    def __init__(self, gain):
        super().__init__(PROBLEM.w, 0.0, PROBLEM.mass, PROBLEM.start)
        object.__setattr__(self, "gain", gain)

    @property
    def stiffness(self):
        return super().stiffness / (1.0 + self.gain)


def test_undeclared_dependence_is_found_too():
    recording = run(Jacobi(2), 0.5, 1e-2, declared=False)
    assert recording.outcome.kind is OutcomeKind.COUPLING_FAILED
    assert "jacobi:order=0" in recording.outcome.message


@pytest.mark.parametrize("algorithm", [GaussSeidel(), Predict()], ids=str)
def test_algorithms_that_tell_bodies_from_elements_refuse(algorithm):
    with pytest.raises(ParameterError, match=r"left depends directly .* use li, fixed_point"):
        algorithm.prepare(build_network(TWO_MASS_SYSTEM, parts(0.5)))


def test_dependence_that_is_declared_but_not_shown_is_noted(monkeypatch):
    monkeypatch.setattr(ResidualMass, "out", lambda self: None)
    notes = run(Jacobi(0), 0.5, 1e-2).notes
    said = "the motion of left depends directly on forces"
    assert any(said in note and "gain of the algebraic loop" in note for note in notes)


def test_message_has_numbers_and_remedy():
    outcome = run(Jacobi(0), 1.05, 1e-2).outcome
    stiffness = PROBLEM.stiffness
    assert outcome.culprit == "left.flange.f"
    for words in (
        "gain of 1.05",
        f"{1.05 / stiffness:.3g} m/N of direct compliance against {stiffness:.3g} N/m",
        "no step helps",
        f"series spring (there {stiffness / 2.05:.3g} in place of {stiffness:.3g})",
        "residual modes",
    ):
        assert words in outcome.message


def test_held_force_is_solved_up_to_a_gain_of_three():
    """5 / 12 g + 1 = 9 / 12 g at the limit."""
    for gain, grows in ((2.9, False), (3.1, True)):
        assert (solved_growth(np.array([[-gain]]), [True]) > 1.0) is grows
    assert solved_growth(np.array([[-3.1]]), [False]) == 0.0


def bearing_stiffness():
    """The stiffest direction of the supports [N/m]."""
    values = BEARING_SUPPORTS.declaration.parameters
    return max(v.start for v in values if v.name.endswith("_stiffness"))


def run_with_housing(folder, capsys, gain, *arguments):
    """Run the test rig with a stranger's housing of a loop gain; exit code, summary, errors."""
    name = f"Residual{100 * gain:.0f}"
    text = RESIDUAL_HOUSING.read_text(encoding="utf-8")
    text = text.replace("RESIDUAL = 0.0", f"RESIDUAL = {gain / bearing_stiffness()!r}")
    script = folder / f"{name.lower()}.py"
    script.write_text(text.replace("ResidualHousing", name), encoding="utf-8")
    build = [sys.executable, "-m", "pythonfmu", "build", "-f", str(script), "-d", str(folder)]
    subprocess.run(build, check=True)
    housing = f"--replace=modal_housing={folder / name}.fmu"
    options = ["--t-end=1e-3", "--fmu=in-process", "--json", "-o", str(folder / "out")]
    code = main(["run", "test_rig", housing, *options, *arguments])
    out, err = capsys.readouterr()
    return code, json.loads(out), err


def test_a_strangers_housing_beyond_one(tmp_path, capsys):
    code, summary, err = run_with_housing(tmp_path, capsys, 1.05)
    assert code == 1
    assert "gearbox.modal_housing." in err
    assert "gain of 1.05" in err
    assert "no step helps" in err
    assert summary["outcome"] == "coupling_failed"
    assert (tmp_path / "out" / "results.csv").is_file()


@pytest.mark.usefixtures("without_pictures")
def test_a_strangers_housing_below_one(tmp_path, capsys):
    code, summary, _ = run_with_housing(tmp_path, capsys, 0.9, "--step=5e-6")
    assert code == 0
    assert any("gain of 0.9:" in note for note in summary["notes"])

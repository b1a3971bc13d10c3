"""Fused runs as a user meets them: results, refusals, interrupts, what stands in the summary."""

import json
from dataclasses import replace

import numpy as np
import pytest

import herringbone as hb
from herringbone.analysis.twin.fused import measured
from herringbone.commands.main import main
from herringbone.core import Outcome, OutcomeKind, ParameterError, StructureError
from herringbone.cosim.interrupt import InterruptFlag
from herringbone.cosim.structure.system_file import read_system
from herringbone.running.fused import fused
from herringbone.running.fused.fused import refuse_strangers
from herringbone.running.reporting.summary import summary_text


@pytest.fixture(scope="module")
def result():
    return hb.run("gearbox", fuse=True, t_end=0.02, record_step=1e-4, reference=True)


def test_result_is_that_of_any_run(result):
    """All recorded outputs and units of a coupled run; the error that was asked for."""
    coupled = hb.run("gearbox", t_end=1e-3, fmu="in-process")
    assert set(result.data.columns) == set(coupled.data.columns)
    assert dict(result.units) == dict(coupled.units)
    assert result.outcome.completed
    assert len(result.data) == 201
    assert 2e-5 < max(result.error.values()) < 1e-3
    assert result.verification.error == pytest.approx(max(result.error.values()), rel=0.5)


def test_summary_has_steps_and_counts(result):
    found = result.summary()["core"]
    assert set(found) == {"degree", "step", "steps", "halvings", "evaluations", "bends"}
    assert found["steps"] >= 200
    text = summary_text(result)
    assert "all parts in one core" in text
    assert "steps of the core" in text
    assert "Micro steps" not in text


def test_chosen_outputs():
    found = hb.run(
        "gearbox", fuse=True, t_end=2e-3, record_step=1e-4, step=1e-4,
        record=["bearing_force", "pinion.*"],
    )  # fmt: skip
    assert list(found.channels) == ["bearing_force"]
    assert len(found.data.columns) == 1 + 8 + 3
    with pytest.raises(StructureError, match=r"no output matches 'nothing'.*bearing_force"):
        hb.run("gearbox", fuse=True, t_end=2e-3, record=["nothing"])
    with pytest.raises(ParameterError, match="only a fused run"):
        hb.run("gearbox", t_end=2e-3, record=["bearing_force"])


def test_what_is_of_a_coupling_is_refused(tmp_path):
    for given in ({"algorithm": "li"}, {"slow": {"gear_mesh": 2}}, {"fmu": "native"}):
        with pytest.raises(ParameterError, match=f"fuse: {next(iter(given))}: of a coupling"):
            hb.run("gearbox", fuse=True, **given)
    stranger = read_system("gearbox").with_fmu("modal_housing", tmp_path / "stranger.fmu")
    with pytest.raises(StructureError, match="fuse: modal_housing: the equations of foreign"):
        refuse_strangers(stranger)


def test_no_step_is_short_enough(monkeypatch):
    monkeypatch.setattr(measured, "SHORTEST", 6e-5)
    with pytest.raises(ParameterError, match=r"no step of the fused system is short enough, .* at"):
        hb.run("gearbox", fuse=True, t_end=2e-3, tolerance=1e-8)


def test_an_interrupted_run_is_resumed(tmp_path, monkeypatch, capsys):
    """With the bits, counts, error and figures of one that was never cut off."""
    options = ["run", "gearbox", "--fuse", "--t-end=0.5", "--record-step=1e-4", "--step=1e-4"]
    options += ["--no-pictures"]
    assert main([*options, "-o", str(tmp_path / "whole")]) == 0
    entered = InterruptFlag.__enter__

    def raised_soon(flag):
        entered(flag)
        looks = iter([False, True])
        type(flag).raised = property(lambda _: next(looks, True), lambda *_: None)
        return flag

    with monkeypatch.context() as patch:
        patch.setattr(InterruptFlag, "raised", False, raising=False)
        patch.setattr(InterruptFlag, "__enter__", raised_soon)
        assert main([*options, "-o", str(tmp_path / "cut")]) == 130
    there = hb.load(tmp_path / "cut")
    assert there.outcome.kind is OutcomeKind.INTERRUPTED
    assert 0 < len(there.data) < 5001
    assert main(["run", "--resume", str(tmp_path / "cut")]) == 0
    capsys.readouterr()
    whole, cut = (hb.load(tmp_path / name) for name in ("whole", "cut"))
    assert cut.data.to_numpy().tobytes() == whole.data.to_numpy().tobytes()
    told = [json.loads((tmp_path / n / "summary.json").read_text()) for n in ("whole", "cut")]
    assert told[0]["core"] == told[1]["core"]
    assert told[0]["verification"] == told[1]["verification"]
    assert told[1]["verification"]["how"].endswith("over the first 20 ms and the last 20 ms")


def test_half_the_step_over_the_whole_run():
    found = hb.run("gearbox", fuse=True, t_end=0.01, record_step=1e-4, step=1e-4, verify=True)
    assert "whole run" in found.verification.how
    assert 1e-5 < found.verification.error < 1e-3
    assert np.isclose(found.verification.step, 5e-5)


@pytest.mark.parametrize("stopped", [1, 2])
def test_no_error_over_the_whole_run_if_a_run_is_interrupted(stopped, monkeypatch):
    """The first one, after which none with half the step is made, or that one."""
    marched, made = fused._marched, []

    def one_of_them(*given):
        made.append(marched(*given))
        late = len(made) == stopped
        return replace(made[-1], outcome=Outcome.interrupted(5e-3)) if late else made[-1]

    monkeypatch.setattr(fused, "_marched", one_of_them)
    found = hb.run("gearbox", fuse=True, t_end=0.01, record_step=1e-4, step=1e-4, verify=True)
    assert len(made) == stopped
    assert "whole run" not in found.verification.how
    which = ("the run", "the run with half the step")[stopped - 1]
    told = f"the error over the whole run is not known: {which} was stopped at 0.005 s"
    assert found.info.notes[-1] == told


def test_curves_of_the_chart():
    found = hb.chart(
        "gearbox", algorithms=["li:degree=3"], steps=[5e-5, 1e-4], t_end=5e-3, fmu="in-process",
        fuse=True,
    )  # fmt: skip
    assert found.algorithms == ("li:degree=3,iterations=1", "fused:degree=4", "fused:degree=5")
    fine, coarse = found.of("fused:degree=4")
    assert fine.worst < 0.2 * coarse.worst < 1e-3
    assert coarse.passes_per_ms < fine.passes_per_ms < 40.0

"""What is left of a chart whose user stops it: the points that are there, and their files."""

import json
import math
from dataclasses import replace

import pytest

import herringbone as hb
from herringbone.analysis.accuracy import step_ladder
from herringbone.analysis.accuracy.work_precision import REFUSED
from herringbone.commands.main import main
from herringbone.core import HerringboneError, Outcome, OutcomeKind
from herringbone.running.fused.loop import FusedRun

SHORT = {"algorithms": ["jacobi"], "steps": [5e-5, 1e-4], "t_end": 5e-3, "fmu": "in-process"}
ENDED = "interrupted: the chart ends with {} at {} us; what was to come after it is not there"


def interrupting(patch, owner, name, number):
    """The call of this number, from 1, is interrupted; later ones are counted, too."""
    made, calls = getattr(owner, name), []

    def call(*given):
        found = made(*given)
        calls.append(found)
        late = len(calls) == number
        return replace(found, outcome=Outcome.interrupted(1e-3)) if late else found

    patch.setattr(owner, name, call)
    return calls


def test_an_interrupt_between_two_runs_keeps_the_points(tmp_path, capsys, monkeypatch):
    made = step_ladder._point

    def point(*given):
        if given[-1].step > 7e-5:
            raise KeyboardInterrupt
        return made(*given)

    monkeypatch.setattr(step_ladder, "_point", point)
    options = ["--algorithm", "jacobi", "--steps", "5e-5", "1e-4", "--t-end", "5e-3", "--fuse"]
    command = ["chart", "gearbox", *options, "--fmu", "in-process", "-o", str(tmp_path), "--json"]
    assert main(command) == 130
    told = json.loads(capsys.readouterr().out)
    assert [p["step"] for p in told["points"]] == pytest.approx([5e-5])
    assert told["notes"][-1] == ENDED.format(told["points"][0]["algorithm"], 50)
    assert {file.name for file in tmp_path.iterdir()} == {"chart.csv", "chart.json", "chart.png"}


def test_without_any_point_there_is_no_chart(monkeypatch):
    monkeypatch.setattr(step_ladder, "_point", lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
    with pytest.raises(KeyboardInterrupt):
        hb.chart("gearbox", **SHORT)


def test_after_an_interrupted_coupled_run_no_core_is_run(monkeypatch):
    interrupting(monkeypatch, step_ladder, "simulate", 2)  # the first one warms up
    monkeypatch.delattr(FusedRun, "go")
    found = hb.chart("gearbox", **SHORT, fuse=True)
    assert [p.outcome for p in found.points] == [OutcomeKind.INTERRUPTED]
    assert found.interrupted


@pytest.mark.parametrize("repeat", [1, 3])
def test_an_interrupted_repeat_of_a_core_is_the_point_s_outcome(repeat, monkeypatch):
    runs = interrupting(monkeypatch, FusedRun, "go", repeat)
    found = hb.chart("gearbox", **SHORT, fuse=True)
    assert len(runs) == repeat
    last = found.points[-1]
    assert (last.outcome, last.t_reached, last.worst) == ("interrupted", 1e-3, math.inf)
    assert last.wall_s == runs[-1].wall_seconds
    assert found.notes[-1] == ENDED.format("fused:degree=4", 50)


def test_steps_that_were_named_and_are_left_out_are_told():
    asked = {**SHORT, "steps": [5e-5, 1.25e-4]}
    notes = hb.chart("gearbox", **asked).notes
    assert notes[-1] == "steps: 0.000125 s: fewer than 50 macro steps in 0.005 s, left out"
    assert not [note for note in hb.chart("gearbox", **SHORT).notes if "left out" in note]


def test_a_reference_that_fails_refuses_its_point_alone(monkeypatch):
    errors = step_ladder.Reference.errors

    def failing(reference, recording):
        if recording.step > 7e-5:
            raise HerringboneError("the twin has no value there")
        return errors(reference, recording)

    monkeypatch.setattr(step_ladder.Reference, "errors", failing)
    found = hb.chart("gearbox", **SHORT)
    assert [p.outcome for p in found.points] == ["completed", REFUSED]
    assert found.notes[-1].endswith("at 100 us: the twin has no value there")

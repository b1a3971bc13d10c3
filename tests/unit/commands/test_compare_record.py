"""`compare RESULTS RECORD`: what a run predicts of a sensor beside a file."""

import json

import numpy as np
import pytest

import herringbone as hb
from herringbone.analysis.figures.sensors import sensor_figures
from herringbone.commands.main import main


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("run") / "results"
    run = [
        "run",
        "test_rig",
        "--fuse",
        "--t-end",
        "1.2",
        "--record-step",
        "1e-4",
        "-o",
        str(folder),
    ]
    assert main(run) == 0
    return folder


def write(file, velocity):
    rows = "\n".join(f"{k / 2000.0!r},{1e3 * v!r}" for k, v in enumerate(velocity.tolist()))
    file.write_text(f"# units: time s, A mm/s\ntime,A\n{rows}\n")


@pytest.fixture(scope="module")
def samples(results):
    one = sensor_figures(hb.load(results))[0]["A"]
    return one.velocity[one.time >= 0.24]


def test_its_own_record_is_the_same(results, samples, tmp_path, capsys):
    write(tmp_path / "own.csv", samples[400:])  # as the prediction, past what filters take
    code = main(["compare", str(results), str(tmp_path / "own.csv"), "--json"])
    found = json.loads(capsys.readouterr().out)
    assert found["faults"] == []
    assert code == 0
    assert found["gain"] == pytest.approx(1.0, abs=0.01)
    assert found["likeness"] > 0.99


def test_faults_are_told_and_lines_are_written(results, samples, tmp_path, capsys):
    noise = 0.02 * samples.std() * np.random.default_rng(1).standard_normal(samples.size)
    write(tmp_path / "wrong.csv", 2.0 * samples + noise)
    out = tmp_path / "out"
    assert main(["compare", str(results), str(tmp_path / "wrong.csv"), "-o", str(out)]) == 1
    told = capsys.readouterr().out
    assert "fault: gain: all its lines are 2" in told
    assert (out / "lines.csv").read_text().startswith("order,mesh_order,frequency,shows_at")


def test_what_is_missing_is_one_line(results, tmp_path, capsys):
    (tmp_path / "a.csv").write_text("time,A\n0,1\n")
    assert main(["compare", str(results), str(tmp_path / "a.csv")]) == 2
    assert "the first line must be '# units" in capsys.readouterr().err
    write(tmp_path / "b.csv", np.zeros(100))
    assert main(["compare", str(results), str(tmp_path / "b.csv"), "--sensor", "Z"]) == 2
    assert "there is no sensor 'Z'; there are: A, B, C" in capsys.readouterr().err

"""`compare RESULTS RECORD`: what a run predicts of a sensor beside a file."""

import json

import numpy as np
import pytest
from scipy.io import wavfile
from support.files.universal_file import write_universal

import herringbone as hb
from herringbone.analysis.figures.sensing.sensors import sensor_figures
from herringbone.analysis.measured.of_run import predicted_of
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
        "--no-pictures",
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


def into_csv(file, velocity):
    write(file, velocity)
    return []


def into_wav(file, velocity):
    wavfile.write(file, 2000, (velocity / 0.05).astype(np.float32))
    return ["--full-scale", "0.05"]


def into_universal(file, velocity):
    write_universal(file, velocity, 2000)
    return []


SUFFIXES = {".csv": into_csv, ".wav": into_wav, ".uff": into_universal}


def sampled(result, faster=1.0):
    """Samples of the run's vibration at sensor A, all of it faster."""
    own = predicted_of(result, "A")
    record = own.sensor.measure(own.vibration, own.step / faster).velocity
    return record[round(0.2 * own.sensor.sampling_hz) :]


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize(
    ("fault", "plant", "number"),
    [
        ("time shift", lambda result: sampled(result)[37:], "begins 18.5"),
        ("gain", lambda result: 2.0 * sampled(result), "are 2"),
        ("other speed", lambda result: sampled(result, 1.2), "120.0"),
    ],
)
def test_planted_faults_are_named_in_each_format(
    results, tmp_path, capsys, suffix, fault, plant, number
):
    """A record that begins 37 samples later, is doubled, or is of 1200 r/min."""
    file = tmp_path / f"wrong{suffix}"
    options = SUFFIXES[suffix](file, plant(hb.load(results)))
    assert main(["compare", str(results), str(file), *options, "--json"]) == 1
    told = capsys.readouterr().out
    faults = json.loads(told, parse_constant=pytest.fail)["faults"]  # NaN is no JSON
    assert [one.partition(":")[0] for one in faults] == [fault]
    assert number in faults[0]


def test_what_is_missing_is_one_line(results, tmp_path, capsys):
    (tmp_path / "a.csv").write_text("time,A\n0,1\n")
    assert main(["compare", str(results), str(tmp_path / "a.csv")]) == 2
    assert "the first line must be '# units" in capsys.readouterr().err
    assert main(["compare", str(results), str(tmp_path / "none.csv")]) == 2
    assert "none.csv does not exist; B is a results folder or a record" in capsys.readouterr().err
    write(tmp_path / "b.csv", np.arange(100.0))
    assert main(["compare", str(results), str(tmp_path / "b.csv"), "--sensor", "Z"]) == 2
    assert "there is no sensor 'Z'; there are: A, B, C" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--highest", "-5"], "--highest -5: it must be positive, in Hz"),
        (["--sensor", "B"], "--sensor: of a measured record; B is a folder"),
        (["--full-scale", "0.1"], "--full-scale: of a measured record; B is a folder"),
    ],
)
def test_options_that_two_folders_do_not_take(results, tmp_path, options, said, capsys):
    out = tmp_path / "out"
    assert main(["compare", str(results), str(results), "-o", str(out), *options]) == 2
    assert said in capsys.readouterr().err
    assert not out.exists() or not list(out.iterdir())


def test_options_that_a_record_does_not_take(results, samples, tmp_path, capsys):
    write(tmp_path / "own.csv", samples[400:])
    assert main(["compare", str(results), str(tmp_path / "own.csv"), "--columns", "*.f_y"]) == 2
    assert "--columns: of two results folders; B is a record" in capsys.readouterr().err

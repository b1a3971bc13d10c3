"""A run that is killed: what it leaves is readable, and `--resume` gives a whole run's bits."""

import json
import os
import resource
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from support.cut_off import Killed, found_in, killed, killed_at, ran, taken_up, write_often

import herringbone as hb
from herringbone.commands.main import main
from herringbone.cosim.rows.stream import Stream
from herringbone.running import api


@pytest.fixture(autouse=True)
def often(monkeypatch):
    write_often(monkeypatch)


RIG = ["run", "test_rig", "--fmu=in-process", "--t-end=0.02"]
ALGORITHMS = [
    [],
    ["--algorithm=li"],
    ["--algorithm=li:tolerance=1e-3"],
    ["--algorithm=jacobi:order=2"],
    ["--algorithm=predict"],
    ["--algorithm=li", "--slow=drive_motor=5,load_motor=5"],
]


@pytest.mark.parametrize("algorithm", ALGORITHMS, ids=" ".join)
def test_a_resumed_run_has_the_bits_of_a_whole_one(tmp_path, capsys, monkeypatch, algorithm):
    """From a checkpoint: rows, table, counts of passes and rollbacks, energy, figures."""
    arguments = [*RIG, *algorithm]
    whole = ran(tmp_path / "whole", arguments)
    folder = tmp_path / "killed"
    killed(folder, arguments, monkeypatch, 3)
    there = hb.load(folder)
    assert 0.0 < there.outcome.time < 0.02
    wanted = hb.load(tmp_path / "whole").data.to_numpy()[: len(there.data)]
    assert there.data.to_numpy().tobytes() == wanted.tobytes()
    assert main([*arguments, "-o", str(folder)]) == 2
    said = capsys.readouterr().err
    assert f"go on with 'herringbone run --resume {folder}'" in said
    found = taken_up(monkeypatch)
    assert main(["run", "--resume", str(folder)]) == 0
    assert len(found) == 1
    assert found[0] > 0
    assert found_in(folder) == whole
    assert not (folder / "checkpoint").exists()


@pytest.mark.parametrize("fmu", ["native", "python"])
def test_fmus_are_resumed_from_a_checkpoint(tmp_path, monkeypatch, fmu):
    arguments = ["run", "gearbox", f"--fmu={fmu}", "--t-end=0.01"]
    whole = ran(tmp_path / "whole", arguments)
    folder = tmp_path / "killed"
    killed(folder, arguments, monkeypatch, 3)
    found = taken_up(monkeypatch)
    assert main(["run", "--resume", str(folder)]) == 0
    assert len(found) == 1
    assert found_in(folder) == whole


def test_a_checkpoint_that_is_wrong_or_damaged_is_not_taken(tmp_path, capsys, monkeypatch):
    """One bit of a state that is another one shows in the rows; then the run is replayed."""
    whole = ran(tmp_path / "whole", RIG)
    for k, damage in enumerate(("state", "file")):
        folder = tmp_path / damage
        killed(folder, RIG, monkeypatch, 3)
        for file in folder.glob("checkpoint*"):
            if damage == "file":
                file.write_bytes(file.read_bytes()[:-100])
                continue
            with np.load(file) as saved:
                state = {name: saved[name].copy() for name in saved.files}
            state["history"][0, -1] = np.nextafter(state["history"][0, -1], np.inf)
            state["part.5"][0] ^= 1
            with file.open("wb") as stream:
                np.savez(stream, **state)
        assert main(["run", "--resume", str(folder)]) == 0
        said = capsys.readouterr().err
        assert ("does not repeat the rows; from the start again" in said) == (k == 0)
        assert found_in(folder) == whole


def test_rows_that_a_replay_does_not_repeat_are_refused(tmp_path, capsys, monkeypatch):
    folder = tmp_path / "killed"
    killed(folder, RIG, monkeypatch, 3)
    for file in folder.glob("checkpoint*"):
        file.unlink()
    with (folder / "results.npy").open("r+b") as stream:
        stream.seek(128 + 8 * 118 * 2 + 8 * 5)
        stream.write(b"\1")
    before = (folder / "results.npy").read_bytes()
    assert main(["run", "--resume", str(folder)]) == 2
    said = capsys.readouterr().err
    assert "the run does not repeat itself" in said
    assert len(said.splitlines()) == 1
    assert (folder / "results.npy").read_bytes() == before


def test_what_has_changed_since_is_refused(tmp_path, capsys, monkeypatch):
    folder = tmp_path / "killed"
    killed(folder, RIG, monkeypatch, 3)
    run = json.loads((folder / "run.json").read_text())
    run["asked"]["t_end"] = 0.03
    (folder / "run.json").write_text(json.dumps(run))
    assert main(["run", "--resume", str(folder)]) == 2
    assert "its scene are not what they were" in capsys.readouterr().err


def test_nothing_to_resume(tmp_path, capsys, monkeypatch):
    """A complete run is shown again; a folder without one, and further options are refused."""
    whole = ran(tmp_path / "whole", RIG)
    assert main(["run", "--resume", str(tmp_path / "whole")]) == 0
    assert capsys.readouterr().out.startswith("test_rig, scene loaded: completed")
    assert found_in(tmp_path / "whole") == whole
    assert main(["run", "--resume", str(tmp_path / "none")]) == 2
    for more in ("--t-end=1", "--speed=0", "--cells", "--no-pictures", "--overwrite"):
        assert main(["run", "--resume", str(tmp_path / "whole"), more]) == 2
        assert "takes all options but --json" in capsys.readouterr().err
    assert main(["run"]) == 2


def test_trials_of_the_first_run_are_limited_in_the_resumed_one(tmp_path, monkeypatch):
    folder, limits = tmp_path / "killed", ["--longest-trial=7", "--most-trial-steps=11"]
    killed(folder, [*RIG, *limits], monkeypatch, 3)
    limited = []

    def run(system, **asked):
        limited.append((asked["longest_trial"], asked["most_trial_steps"]))
        raise hb.HerringboneError(system)

    monkeypatch.setattr(api, "run", run)
    assert main(["run", "--resume", str(folder)]) == 2
    assert limited == [(7, 11)]


def test_killed_while_the_report_is_written(tmp_path, monkeypatch):
    """What it was told about pictures holds for the rest of the report, too."""
    options = [*RIG, "--no-pictures"]
    drawn = "herringbone.plotting.write_pictures"
    monkeypatch.setattr(drawn, lambda result, folder: pytest.fail("it draws"))
    whole = ran(tmp_path / "whole", options)
    folder = tmp_path / "killed"
    killed_at(folder, options, monkeypatch, "herringbone.running.reporting.report.write_csv")
    assert hb.load(folder).outcome.completed
    assert main(["run", "--resume", str(folder)]) == 0
    assert found_in(folder) == whole


def test_killed_before_a_further_run_told_the_error(tmp_path, capsys, monkeypatch):
    """Its rows are whole, and its files are written; but it is not what was asked for."""
    folder = tmp_path / "killed"
    options = [*RIG, "--algorithm=li:degree=3", "--verify"]
    killed_at(folder, options, monkeypatch, "herringbone.running.prepared_runs.verified")
    for _ in range(2):
        assert main(["run", "--resume", str(folder)]) == 2
        said = capsys.readouterr().err
        assert "the process ended before its error was known" in said
    assert (folder / "results.csv").is_file()


def test_a_run_that_still_looks_for_its_error_is_left_alone(tmp_path, capsys, monkeypatch):
    folder, said = tmp_path / "out", []

    def meanwhile(*arguments, **options):
        assert main(["run", "--resume", str(folder)]) == 2
        said.append(capsys.readouterr().err)
        raise Killed

    with monkeypatch.context() as patched:
        patched.setattr("herringbone.running.prepared_runs.verified", meanwhile)
        with pytest.raises(Killed):
            main([*RIG, "--algorithm=li:degree=3", "--verify", "-o", str(folder)])
    assert "another run is writing into" in said[0]


def test_a_column_that_was_no_number_before_the_checkpoint(tmp_path, capsys, monkeypatch):
    """The resumed run ends as the whole one, though it never sees those rows."""
    append = Stream._append

    def first_are_nan(self, times, values, others):
        values[times < 1e-4, 0] = np.nan
        append(self, times, values, others)

    monkeypatch.setattr(Stream, "_append", first_are_nan)
    options = [*RIG, "--algorithm=li"]
    assert main([*options, "-o", str(tmp_path / "whole")]) == 1
    whole = capsys.readouterr().err
    killed(tmp_path / "killed", options, monkeypatch, 3)
    begun = taken_up(monkeypatch)
    assert main(["run", "--resume", str(tmp_path / "killed")]) == 1
    assert begun
    assert begun[0] * 4e-5 > 1e-4
    (line,) = [line for line in whole.splitlines() if "completed_with_nan" in line]
    assert line in capsys.readouterr().err
    assert found_in(tmp_path / "killed") == found_in(tmp_path / "whole")


@pytest.mark.parametrize("kilobytes", [0, 1, 60, 400, 600, 2000])
def test_a_disk_that_is_full(tmp_path, capsys, monkeypatch, kilobytes):
    """No file may be larger: one line, rows that are those of a whole run, and more of them later.

    600 records of 118 doubles are 470 kB, and as text about three times as many.
    """
    whole = ran(tmp_path / "whole", RIG)
    capsys.readouterr()
    folder = tmp_path / "full"
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (1024 * kilobytes, before[1]))
        code = main([*RIG, "-o", str(folder)])
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    said = capsys.readouterr().err.splitlines()
    assert (code, len(said)) in {(2, 1), (0, 0)}
    if code == 0:
        assert found_in(folder) == whole
        return
    assert "cannot write" in said[0]
    assert "make room" in said[0]
    if not (folder / "run.json").exists():
        return
    there = hb.load(folder).data.to_numpy()
    assert there.tobytes() == hb.load(tmp_path / "whole").data.to_numpy()[: len(there)].tobytes()
    assert main(["run", "--resume", str(folder)]) == 0
    assert found_in(folder) == whole


@pytest.mark.skipif(os.name == "nt", reason="no SIGKILL")
def test_kill_9(tmp_path):
    """The process is killed as soon as it has rows; they are those of the run."""
    folder = tmp_path / "out"
    options = ["--fmu=in-process", "--algorithm=li", "--t-end=5", "-o", str(folder)]
    with subprocess.Popen(
        [sys.executable, "-m", "herringbone", "run", "test_rig", *options],
        stderr=subprocess.DEVNULL,
    ) as process:
        try:
            end = time.monotonic() + 300.0
            while time.monotonic() < end and process.poll() is None:
                time.sleep(0.05)
                if (folder / "run.json").exists() and hb.load(folder).outcome.time > 0.01:
                    break
        finally:
            process.send_signal(signal.SIGKILL)
    found = hb.load(folder)
    assert np.allclose(np.diff(found.data["time"]), 4e-5, rtol=1e-6)
    short = hb.run("test_rig", fmu="in-process", algorithm="li", t_end=0.01)
    same = short.data.to_numpy()[:200, 1:]
    assert found.data.to_numpy()[: len(same), 1:].tobytes() == same.tobytes()

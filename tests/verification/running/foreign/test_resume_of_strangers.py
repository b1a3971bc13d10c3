"""Runs of foreign FMUs that are cut off are replayed, whatever the FMUs say of their states."""

import subprocess
import sys

import numpy as np
import pytest
from support.cut_off import found_in, killed, ran, taken_up, write_often
from support.foreign.kinds import KINDS
from support.foreign.reel import python_reel, reels
from support.foreign.strangers import write_system

import herringbone as hb
from herringbone.commands.main import main


@pytest.fixture(autouse=True)
def often(monkeypatch):
    write_often(monkeypatch)


def replays(folder, monkeypatch, arguments, appends):
    """Kill a run and resume it: its rows are those of a whole one, and none is taken up."""
    whole = ran(folder / "whole", arguments)
    out = folder / "killed"
    killed(out, arguments, monkeypatch, appends)
    there = hb.load(out).data.to_numpy()
    wanted = hb.load(folder / "whole").data.to_numpy()
    assert 0 < len(there) < len(wanted)
    assert there.tobytes() == wanted[: len(there)].tobytes()
    found = taken_up(monkeypatch)
    assert main(["run", "--resume", str(out)]) == 0
    assert found == []
    assert found_in(out) == whole


@pytest.mark.parametrize(("saves", "housing"), [(True, "--cells"), (False, "--in-process")])
def test_strangers_are_replayed(tmp_path, monkeypatch, saves, housing):
    system = reels(tmp_path, saves=saves)
    options = ["--step=1e-4", "--t-end=0.05", "--set=left.holds=350", "--set=right.holds=1e9"]
    replays(tmp_path, monkeypatch, ["run", str(system), *options, housing], 3)


def test_a_hidden_state_decides_late(tmp_path, monkeypatch):
    """A checkpoint without it would repeat the first rows, and give others in the end."""
    system = write_system(tmp_path, "alone", [], {"left": python_reel(tmp_path)})
    options = ["--step=1e-4", "--t-end=0.5", "--record-step=1e-4", "--set=left.holds=4000"]
    replays(tmp_path, monkeypatch, ["run", str(system), *options, "--in-process"], 6)
    speed = hb.load(tmp_path / "whole").data["left.v"].to_numpy()
    assert np.ptp(speed[:4000]) == 0.0
    assert speed[-1] < 0.01  # exp(-2000 / 40 * 0.1)


def test_what_does_not_repeat_itself_is_refused(tmp_path, capsys, monkeypatch):
    """A sensor with noise: its rows stay as they are."""
    build = [sys.executable, "-B", str(KINDS / "build.py"), str(tmp_path), "wheel_speed_sensor.py"]
    subprocess.run(build, check=True, capture_output=True, cwd=tmp_path)
    files = {"sensor": next(tmp_path.glob("*.fmu"))}
    system = write_system(tmp_path, "alone", [], files)
    options = ["--step=1e-4", "--t-end=0.5", "--record-step=1e-4", "--in-process"]
    folder = tmp_path / "killed"
    killed(folder, ["run", str(system), *options], monkeypatch, 3)
    before = (folder / "results.npy").read_bytes()
    assert main(["run", "--resume", str(folder)]) == 2
    (said,) = capsys.readouterr().err.splitlines()
    assert "the run does not repeat itself" in said
    assert (folder / "results.npy").read_bytes() == before

"""Parts that end, move or crash the process: results that exist are there, and none looks good."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest
from support.foreign.hostile import Deed, Place, hostile_fmu

from herringbone.core.places.paths import cache_root

cells = pytest.mark.skipif(sys.platform != "linux", reason="cells need Linux")
pytestmark = pytest.mark.skipif(os.name == "nt", reason="written for POSIX")


@pytest.fixture(scope="module")
def system(tmp_path_factory):
    """Folder of a system: the hostile part alone."""
    folder = tmp_path_factory.mktemp("hostile")
    hostile_fmu(folder)
    (folder / "system.toml").write_text('[parts.stranger]\nfmu = "hostile.fmu"\n')
    return folder


def command(system, *options):
    own = [
        sys.executable,
        "-m",
        "herringbone",
        "run",
        str(system),
        "--step",
        "1e-5",
        "--no-pictures",
    ]
    return [*own, *options]


def run(system, folder, place, deed, *more):
    """Run for 1 ms in a process of its own; (exit code, what it said)."""
    values = ["--set", f"stranger.place={int(place)}", "--set", f"stranger.deed={int(deed)}"]
    options = [*values, "--t-end", "0.001", "-o", "out", *more]
    found = subprocess.run(
        command(system, *options), cwd=folder, capture_output=True, text=True, check=False
    )
    return found.returncode, found.stderr


def rows(folder, outcome="completed"):
    """Rows of the results; the summary is there, too."""
    summary = json.loads((folder / "out" / "summary.json").read_text())
    assert summary["outcome"] == outcome
    return len(pd.read_csv(folder / "out" / "results.csv"))


@pytest.mark.parametrize("place", [Place.TERMINATE, Place.FREE])
@pytest.mark.parametrize("deed", [Deed.EXIT, Deed.ABORT, Deed.MOVE, Deed.CRASH])
def test_results_are_there_whatever_happens_after_the_end(system, tmp_path, place, deed):
    """In this process the run's process ends as the FMU wants."""
    code, said = run(system, tmp_path, place, deed, "--in-process")
    assert rows(tmp_path) == 51
    assert "Traceback" not in said
    expected = {
        Deed.EXIT: 1, Deed.ABORT: -signal.SIGABRT, Deed.MOVE: 0, Deed.CRASH: -signal.SIGSEGV
    }  # fmt: skip
    assert code == expected[deed]


@cells
@pytest.mark.parametrize("deed", [Deed.MOVE, Deed.CRASH])
def test_what_a_cell_finds_after_the_end_is_in_the_summary(system, tmp_path, deed):
    code, said = run(system, tmp_path, Place.FREE, deed, "--cells")
    crashed = deed is Deed.CRASH
    assert rows(tmp_path, "completed_part_lost" if crashed else "completed") == 51
    assert code == crashed
    assert ("signal 11 (SIGSEGV) in free" in said) == crashed
    summary = (tmp_path / "out" / "summary.txt").read_text()
    assert ("stranger did not survive its end" if crashed else "the working folder") in summary


@cells
def test_a_crash_in_a_step_is_an_outcome(system, tmp_path):
    """Cells are the default."""
    code, said = run(system, tmp_path, Place.LATE_STEP, Deed.CRASH)
    assert code == 1
    assert "part_failed: stranger" in said
    assert "signal 11 (SIGSEGV) in doStep at 0.0005" in said
    assert 20 < rows(tmp_path, "part_failed") < 51


@pytest.mark.parametrize("housing", ["--in-process", pytest.param("--cells", marks=cells)])
def test_a_changed_working_folder_moves_nothing(system, tmp_path, housing):
    assert run(system, tmp_path, Place.STEP, Deed.MOVE, housing)[0] == 0
    assert rows(tmp_path) == 51


@pytest.mark.parametrize("place", [Place.STEP, Place.LATE_STEP])
def test_exit_inside_a_step_is_no_success(system, tmp_path, place):
    code, said = run(system, tmp_path, place, Deed.EXIT, "--in-process")
    assert code == 1
    assert "an FMU ended the process by a call of exit()" in said


def test_parts_are_terminated(system, tmp_path):
    code, said = run(system, tmp_path, Place.TERMINATE, Deed.SAY, "--in-process")
    assert (code, said.count("the hostile part was called")) == (0, 1)


@cells
def test_output_of_a_part_goes_to_a_log(system, tmp_path):
    code, said = run(system, tmp_path, Place.TERMINATE, Deed.SAY, "--cells")
    assert code == 0
    assert "the hostile part was called" not in said
    notes = json.loads((tmp_path / "out" / "summary.json").read_text())["notes"]
    log = next(note for note in notes if "bytes of output" in note).split(": ")[-1]
    assert Path(log).read_text() == "the hostile part was called\n"


@cells
def test_cells_end_with_a_killed_run(system, tmp_path):
    """No process and no folder is left behind by kill -9."""
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    with subprocess.Popen(
        command(system, "--cells", "--t-end", "1000", "--record-step", "0.1", "-o", "out"),
        cwd=tmp_path, stderr=subprocess.DEVNULL, env={**os.environ, "TMPDIR": str(scratch)},
    ) as process:  # fmt: skip
        found = wait_for(lambda: children(process.pid) and list(scratch.glob("herringbone_*")))
        assert found
        cell = children(process.pid)
        process.kill()
    assert wait_for(lambda: not any(Path(f"/proc/{each}").exists() for each in cell))
    assert wait_for(lambda: not list(scratch.glob("herringbone_*")))


def wait_for(true, seconds=60.0):
    end = time.monotonic() + seconds
    while not (found := true()) and time.monotonic() < end:
        time.sleep(0.05)
    return found


def children(pid):
    """Processes whose parent is `pid`."""
    found = []
    for status in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            if status.read_text().rsplit(")", 1)[1].split()[1] == str(pid):
                found.append(status.parent.name)
    return found


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_keeps_what_was_computed(system, tmp_path, number):
    """The handler is in place when the loop runs: the part says so."""
    say = ["--set", f"stranger.place={int(Place.LATE_STEP)}", "--set"]
    say += [f"stranger.deed={int(Deed.SAY)}", "--in-process"]
    options = ["--t-end", "1000", "--record-step", "0.1", "-o", "out", *say]
    with subprocess.Popen(
        command(system, *options), cwd=tmp_path, stderr=subprocess.PIPE, text=True
    ) as process:
        for line in process.stderr:
            if "was called" in line:
                break
        time.sleep(0.1)
        process.send_signal(number)
        process.communicate(timeout=60)
    assert process.returncode == 128 + number
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert summary["outcome"] == "interrupted"
    assert (tmp_path / "out" / "results.csv").is_file()


@cells
def test_ctrl_c_is_for_the_master(system, tmp_path):
    """The terminal sends it to all processes of the group, and this test to the cell itself."""
    say = ["--set", f"stranger.place={int(Place.LATE_STEP)}", "--set"]
    say += [f"stranger.deed={int(Deed.SAY)}", "--cells"]
    options = ["--t-end", "1000", "--record-step", "0.1", "-o", "out", *say]
    with subprocess.Popen(
        command(system, *options), cwd=tmp_path, start_new_session=True, stderr=subprocess.DEVNULL
    ) as process:
        logs = cache_root() / "cell-logs"
        assert wait_for(lambda: list(logs.glob(f"stranger-{process.pid}-*.log")))
        (cell,) = children(process.pid)
        os.kill(int(cell), signal.SIGINT)
        time.sleep(0.1)
        assert children(process.pid) == [cell]
        os.killpg(process.pid, signal.SIGINT)
        process.communicate(timeout=60)
    assert process.returncode == 130
    assert not Path(f"/proc/{cell}").exists()
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert summary["outcome"] == "interrupted"
    assert (tmp_path / "out" / "results.csv").is_file()

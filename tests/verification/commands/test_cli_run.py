"""`herringbone run`: files, JSON, and the interrupt."""

import csv
import json
import math
import os
import select
import signal
import subprocess
import sys
import time
from decimal import Decimal
from pathlib import Path

import pandas as pd
import pytest

from herringbone.commands.main import main
from herringbone.components.registry import COMPONENTS
from herringbone.core.declaring.variable import Causality
from herringbone.cosim.structure.system_file import read_system
from herringbone.running.reporting.progress import Bar

KEYS = {
    "outcome", "scene", "model", "t_end", "communication_step", "micro_step", "algorithm",
    "macro_steps", "passes", "rollbacks", "wall_s", "results",
}  # fmt: skip
PARTS = {part.name: part.component for part in read_system("test_rig").parts}


def run(capsys, folder, *arguments):
    """The JSON object of a run of 5 ms, which is all that is printed."""
    options = ("--t-end", "0.005", "-o", str(folder), "--json", *arguments)
    assert main(["run", "test_rig", *options]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    assert len(out.splitlines()) == 1
    return json.loads(out)


def columns():
    """All outputs of all parts."""
    return {
        f"{part}.{v.name}"
        for part, component in PARTS.items()
        for v in COMPONENTS[component].declaration.variables
        if v.causality is Causality.OUTPUT
    }


JACOBI = ("--algorithm", "jacobi:order=2")


@pytest.mark.usefixtures("without_pictures")
def test_default_algorithm(tmp_path, capsys):
    """Steps follow a tolerance of 1e-3; rows are 50 us apart, and the estimate is within it."""
    found = run(capsys, tmp_path, "--fmu", "in-process")
    assert found["algorithm"] == "li:degree=3,iterations=1,tolerance=0.001"
    assert found["tolerance_by_default"]
    assert found["record_step"] == pytest.approx(5e-5, rel=1e-12)
    estimate = found["estimate"]
    assert estimate["asked"] == 1e-3
    assert 0.0 < math.hypot(estimate["coupling"], estimate["inner_steps"]) < 1e-3
    assert found["notes"][0].startswith("tolerance = 0.001 (default): li:degree=3")
    header = (tmp_path / "summary.txt").read_text().splitlines()[3]
    assert "li:degree=3,iterations=1,tolerance=0.001 (default)" in header


@pytest.mark.parametrize(
    ("asked", "algorithm"),
    [
        (("--step", "4e-5"), "li:degree=3,iterations=1"),
        (("--algorithm", "jacobi:order=2"), "jacobi:order=2"),
        (("--slow", "drive_motor=5"), "li:degree=3,iterations=1"),
        (("--tolerance", "1e-3"), "li:degree=3,iterations=1,tolerance=0.001"),
    ],
)
@pytest.mark.usefixtures("without_pictures")
def test_what_is_said_wins_over_the_default_tolerance(tmp_path, capsys, asked, algorithm):
    found = run(capsys, tmp_path, "--fmu", "in-process", *asked)
    assert found["algorithm"].startswith(algorithm)
    assert not found["tolerance_by_default"]
    assert (found["estimate"] is not None) == ("--tolerance" in asked)


@pytest.mark.usefixtures("without_pictures")
def test_li_by_name(tmp_path, capsys):
    """Equal steps; with one correction two passes and one rollback each."""
    found = run(capsys, tmp_path, "--fmu", "in-process", "--algorithm", "li:degree=3")
    assert found["algorithm"] == "li:degree=3,iterations=1"
    assert found["macro_steps"] == 125
    jacobian = 1 + 3 * 24  # one pass per unknown: 24 forces at 3 nodes
    own = 1 + 3 * 10  # of them those that the gears take
    first = 1  # the first step, predicted from one point, is corrected twice
    assert found["passes"]["gearbox.gear_mesh"] == 2 * 125 + own + first
    assert found["rollbacks"] == 125 + jacobian + first


@pytest.mark.parametrize("fmu", ["python", "in-process"])
def test_json(tmp_path, capsys, fmu):
    found = run(capsys, tmp_path, "--fmu", fmu, *JACOBI)
    assert set(found) >= KEYS
    assert "error" not in found
    assert (found["outcome"], found["scene"], found["model"]) == ("completed", "loaded", PARTS)
    assert (found["t_end"], found["communication_step"]) == (0.005, 1e-5)
    assert found["micro_step"] == 2.5e-6
    assert found["algorithm"].startswith("jacobi:order=2")
    assert (found["macro_steps"], found["rollbacks"]) == (500, 0)
    assert found["passes"] == dict.fromkeys(PARTS, 500)
    assert 0.0 < found["wall_s"] < 60.0
    assert str(tmp_path / "results.csv") in found["results"]
    assert all(os.path.getsize(file) for file in found["results"])  # noqa: PTH202 (any file)
    assert json.loads((tmp_path / "summary.json").read_text()).items() >= found.items()


@pytest.mark.usefixtures("without_pictures")
def test_reference(tmp_path, capsys):
    """At 10 us, order 2, the README's 0.17 % of bearing force over 20 ms; 1 % is a bound."""
    found = run(capsys, tmp_path, "--reference", "--fmu", "in-process", *JACOBI)
    assert set(found["error"]) == {"bearing_force", "seat_velocity"}
    assert all(0.0 < error < 0.01 for error in found["error"].values())
    assert found["record_step"] == 2e-5
    assert len(pd.read_csv(tmp_path / "results.csv")) == 251


@pytest.mark.usefixtures("without_pictures")
def test_results_csv(tmp_path, capsys):
    run(capsys, tmp_path, "--parquet", "--fmu", "in-process", *JACOBI)
    lines = (tmp_path / "results.csv").read_text().splitlines()
    header = lines[0].split(",")
    assert header[0] == "time"
    assert len(header) == len(set(header))
    assert set(header[1:]) == columns()
    units = dict(csv.reader((tmp_path / "units.csv").read_text().splitlines()[1:]))
    assert list(units) == header
    assert units["time"] == "s"
    assert units["gearbox.gear_mesh.pinion_left.s_y"] == "m"
    rows = list(csv.reader(lines[1:]))
    assert len(rows) == 251
    assert all(len(row) == len(header) for row in rows)
    assert (rows[0][0], float(rows[-1][0])) == ("0.0", 0.005)
    assert all(Decimal(repr(float(x))) == Decimal(x) for row in rows[::50] for x in row)
    parquet = pd.read_parquet(tmp_path / "results.parquet")
    table = pd.read_csv(tmp_path / "results.csv", dtype=str).astype(float)
    pd.testing.assert_frame_equal(parquet, table, check_exact=True)


SHORT = ("--t-end", "0.001", "--scene", "runup", "--start", "rest", "--fmu", "in-process")


def test_default_folder(tmp_path, capsys, monkeypatch):
    """What others have filled gets a number, and a line says so."""
    monkeypatch.chdir(tmp_path)
    assert main(["run", "test_rig", *SHORT]) == 0
    assert capsys.readouterr().out.startswith("test_rig, scene runup: completed")
    assert (tmp_path / "results" / "test_rig-runup" / "results.csv").is_file()
    assert main(["run", "test_rig", *SHORT, "--record-step", "1e-4"]) == 0
    assert "results go to results/test_rig-runup-2: " in capsys.readouterr().err
    assert (tmp_path / "results" / "test_rig-runup-2" / "results.csv").is_file()


@pytest.mark.parametrize(("given", "name"), [(".", "here"), ("", "here"), ("..", "")])
def test_the_current_folder_and_the_one_above(tmp_path, capsys, monkeypatch, given, name):
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    assert main(["run", "test_rig", *SHORT, "--no-pictures", "-o", given]) == 0
    assert (tmp_path / name / "results.csv").is_file()
    assert capsys.readouterr().out.startswith("test_rig, scene runup: completed")


def read_until(terminal, text, seconds):
    """What a terminal shows, up to a text."""
    shown, end = b"", time.monotonic() + seconds
    while text not in shown:
        ready, _, _ = select.select([terminal], [], [], max(0.0, end - time.monotonic()))
        assert ready, f"{text} was not shown within {seconds} s; shown: {shown!r}"
        shown += os.read(terminal, 4096)
    return shown


def cpu_seconds(process):
    """CPU time that a process has taken; other work of the machine does not count."""
    fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


@pytest.mark.skipif(not Path("/proc/self/stat").is_file(), reason="needs Linux: terminal, CPU time")
@pytest.mark.parametrize("fmu", ["python", "in-process"])
def test_interrupt(tmp_path, fmu):
    """Ctrl-C while the bar moves: it ends within 0.5 s of CPU, then files are written."""
    import termios

    run_rig = ["run", "test_rig", "--algorithm", "li", "--t-end", "60", "--fmu", fmu]
    terminal, stderr = os.openpty()
    termios.tcsetwinsize(stderr, (40, 120))
    with subprocess.Popen(
        [sys.executable, "-m", "herringbone", *run_rig, "-o", str(tmp_path)],
        stdout=subprocess.PIPE,
        stderr=stderr,
    ) as process:
        os.close(stderr)
        try:
            read_until(terminal, b"simulated", 300.0)
            process.send_signal(signal.SIGINT)
            sent = cpu_seconds(process)
            said = read_until(terminal, b"\n", 10.0).partition(b"\n")[2]
            ended = cpu_seconds(process) - sent
            said = (said if b"\n" in said else said + read_until(terminal, b"\n", 60.0)).decode()
            process.communicate(timeout=60)
        finally:
            process.kill()
            os.close(terminal)
    assert process.returncode == 130
    assert ended < 0.5
    assert said.startswith("herringbone: interrupted")
    assert f"results so far are kept, and are being written to {tmp_path}" in said
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["outcome"] == "interrupted"
    table = pd.read_csv(tmp_path / "results.csv")
    assert table.notna().all(axis=None)
    assert 0.0 < summary["t_reached"] < 60.0
    assert table["time"].iloc[-1] == pytest.approx(summary["t_reached"], abs=2e-5)


def test_a_terminated_run_keeps_its_rows_and_draws_nothing(tmp_path, capsys, monkeypatch):
    """Who terminates kills after some seconds: pictures can be drawn later."""

    def show(bar, reached, end):
        if reached > 0.01:
            signal.raise_signal(signal.SIGTERM)

    monkeypatch.setattr(Bar, "show", show)
    folder = tmp_path / "run"
    arguments = ["run", "gearbox", "--fmu", "in-process", "--t-end", "5", "-o", str(folder)]
    assert main(arguments) == 128 + signal.SIGTERM
    said = capsys.readouterr().err
    assert f"no pictures; 'herringbone plot {folder}' draws them" in said
    assert json.loads((folder / "summary.json").read_text())["outcome"] == "interrupted"
    assert len(pd.read_csv(folder / "results.csv")) > 1
    assert not list(folder.glob("*.png"))

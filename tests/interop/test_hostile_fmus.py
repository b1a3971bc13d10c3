"""Parts that end, move or crash the process: results that exist are there, and none looks good."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest
from support.c_fmu import compiled_fmu

SOURCE = Path(__file__).parents[1] / "fmus" / "hostile.c"
STEP, LATE_STEP, TERMINATE, FREE = 1, 2, 3, 4
EXIT, ABORT, MOVE, CRASH, SAY = 1, 2, 3, 4, 5
DESCRIPTION = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="hostile" guid="h" numberOfEventIndicators="0">
<CoSimulation modelIdentifier="hostile" canHandleVariableCommunicationStepSize="true"/>
<ModelVariables>
<ScalarVariable name="place" valueReference="0" causality="parameter" variability="fixed">
<Real start="0"/></ScalarVariable>
<ScalarVariable name="deed" valueReference="1" causality="parameter" variability="fixed">
<Real start="0"/></ScalarVariable>
<ScalarVariable name="u" valueReference="2" causality="input"><Real start="0"/></ScalarVariable>
<ScalarVariable name="y" valueReference="3" causality="output"><Real/></ScalarVariable>
</ModelVariables>
<ModelStructure><Outputs><Unknown index="4" dependencies=""/></Outputs>
<InitialUnknowns><Unknown index="4" dependencies=""/></InitialUnknowns></ModelStructure>
</fmiModelDescription>
"""
pytestmark = pytest.mark.skipif(os.name == "nt", reason="written for POSIX")


@pytest.fixture(scope="module")
def system(tmp_path_factory):
    """Folder of a system: the hostile part alone."""
    folder = tmp_path_factory.mktemp("hostile")
    compiled_fmu(SOURCE, DESCRIPTION, folder)
    (folder / "system.toml").write_text('[parts.stranger]\nfmu = "hostile.fmu"\n')
    return folder


def command(system, *options):
    return [sys.executable, "-m", "herringbone", "run", str(system), "--step", "1e-5", *options]


def run(system, folder, place, deed):
    """Run for 1 ms in a process of its own; (exit code, what it said)."""
    values = ["--set", f"stranger.place={place}", "--set", f"stranger.deed={deed}"]
    options = [*values, "--t-end", "0.001", "-o", "out"]
    found = subprocess.run(
        command(system, *options), cwd=folder, capture_output=True, text=True, check=False
    )
    return found.returncode, found.stderr


def rows(folder):
    """Rows of the results; the summary is there, too."""
    summary = json.loads((folder / "out" / "summary.json").read_text())
    assert summary["outcome"] == "completed"
    return len(pd.read_csv(folder / "out" / "results.csv"))


@pytest.mark.parametrize("place", [TERMINATE, FREE])
@pytest.mark.parametrize("deed", [EXIT, ABORT, MOVE, CRASH])
def test_results_are_there_whatever_happens_after_the_end(system, tmp_path, place, deed):
    code, said = run(system, tmp_path, place, deed)
    assert rows(tmp_path) == 51
    assert "Traceback" not in said
    expected = {EXIT: 1, ABORT: -signal.SIGABRT, MOVE: 0, CRASH: -signal.SIGSEGV}
    assert code == expected[deed]


def test_a_changed_working_folder_moves_nothing(system, tmp_path):
    assert run(system, tmp_path, STEP, MOVE)[0] == 0
    assert rows(tmp_path) == 51


@pytest.mark.parametrize("place", [STEP, LATE_STEP])
def test_exit_inside_a_step_is_no_success(system, tmp_path, place):
    code, said = run(system, tmp_path, place, EXIT)
    assert code == 1
    assert "an FMU ended the process by a call of exit()" in said


def test_parts_are_terminated(system, tmp_path):
    code, said = run(system, tmp_path, TERMINATE, SAY)
    assert (code, said.count("the hostile part was called")) == (0, 1)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_keeps_what_was_computed(system, tmp_path, number):
    """The handler is in place when the loop runs: the part says so."""
    say = ["--set", f"stranger.place={LATE_STEP}", "--set", f"stranger.deed={SAY}"]
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
    assert process.returncode == 130
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert summary["outcome"] == "interrupted"
    assert (tmp_path / "out" / "results.csv").is_file()

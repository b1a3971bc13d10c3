"""Adaptive steps of FMUs: the same bits as in-process, and a stranger that saves its state."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from support.parts.running import columns, run_fmus_and_in_process

from herringbone.commands.main import main
from herringbone.cosim.algorithms import LI
from herringbone.cosim.simulation import make_grid
from herringbone.cosim.structure.system_file import find_system, read_system
from herringbone.running.start import started
from herringbone.scenes import find_scene, read_scene

STRANGER = Path(__file__).parents[2] / "fmus" / "strange_housing.py"


def test_python_fmus_give_the_same_bits(python_fmus):
    scene = read_scene(find_scene(find_system("test_rig"), "separation"))
    system = started(read_system("test_rig"), scene)[0]
    grid = make_grid(2e-3, 2e-4, 2e-4)
    found, wanted = run_fmus_and_in_process(system, python_fmus, LI(tolerance=1e-3), grid)
    assert found.steps == wanted.steps
    assert found.steps.rejected > 0
    assert np.array_equal(columns(found, wanted.names), wanted.values)


@pytest.mark.usefixtures("without_pictures")
def test_a_strangers_fmu_with_state(tmp_path, capsys):
    """An adaptive step by name; with `--tolerance` alone the step is fixed, and found by runs."""
    script = tmp_path / "steppedhousing.py"
    script.write_text(STRANGER.read_text().replace("StrangeHousing", "SteppedHousing"))
    command = [sys.executable, "-m", "pythonfmu", "build", "--handle-state"]
    subprocess.run([*command, "-f", str(script), "-d", str(tmp_path)], check=True)
    replace = f"--replace=modal_housing={tmp_path / 'SteppedHousing.fmu'}"
    output = ["--json", "--overwrite", "-o", str(tmp_path / "out")]
    command = ["run", "test_rig", "--t-end=1e-3", replace, *output]
    assert main([*command, "--algorithm=li:tolerance=1e-2"]) == 0
    summary = json.loads(capsys.readouterr().out)
    steps = summary["steps"]
    assert set(steps) == {"accepted", "rejected", "shortest", "median", "longest"}
    assert steps["accepted"] == summary["macro_steps"]
    assert any("gearbox.modal_housing: a body by trial steps" in n for n in summary["notes"])
    table = pd.read_csv(tmp_path / "out" / "results.csv")
    assert table["time"].diff().dropna().to_numpy() == pytest.approx(1e-4, rel=1e-9)
    assert steps["longest"] <= 1e-4 * (1.0 + 1e-9)
    assert main([*command, "--tolerance=1e-2"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert "steps" not in summary
    assert max(summary["verification"]["groups"].values()) <= 1e-2

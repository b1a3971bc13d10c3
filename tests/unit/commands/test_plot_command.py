"""The command plot: pictures of folders of runs and of sweeps, afterwards."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from support.result import make_result

from herringbone.commands.main import main
from herringbone.running.reporting.report import write_report


@pytest.fixture
def folder(tmp_path, monkeypatch):
    result = make_result(t_end=0.1, record_step=1e-4)
    speed = np.linspace(40.0, 120.0, len(result.data))
    data = result.data.assign(**{"gearbox.gear_mesh.pinion.w": speed})
    with monkeypatch.context() as patch:
        patch.setattr("herringbone.plotting.write_pictures", lambda result, folder: [])
        write_report(replace(result, data=data), tmp_path / "run")
    return tmp_path / "run"


def test_pictures_of_columns(folder, tmp_path, capsys):
    out = tmp_path / "pictures"
    command = ["plot", str(folder), "--columns", "*.pinion_left.f_y", "--highest", "2000"]
    assert main([*command, "-o", str(out)]) == 0
    assert {file.name for file in out.iterdir()} == {"columns.png", "run_up.png"}
    assert "columns.png" in capsys.readouterr().out


def test_all_pictures_of_a_run(folder, monkeypatch):
    monkeypatch.setattr("herringbone.plotting.runs.pictures.PICTURES", {})  # the slow ones
    assert main(["plot", str(folder), "--highest", "4000"]) == 0
    assert {"overview.png", "spectra.png", "run_up.png"} <= {f.name for f in folder.iterdir()}


def test_pictures_of_a_sweep(tmp_path, capsys):
    table = pd.DataFrame({
        "point": range(9), "speed": np.linspace(500.0, 900.0, 9), "outcome": "completed",
        "message": "", "mesh_frequency": 0.45 * np.linspace(500.0, 900.0, 9),
        "force.rms": np.arange(9) + 1.0, "force.order_1": np.arange(9) + 1.0,
    })  # fmt: skip
    table.to_csv(tmp_path / "table.csv", index=False)
    (tmp_path / "units.csv").write_text("column,unit\nspeed,r/min\nforce.rms,N\n")
    assert main(["plot", str(tmp_path)]) == 0
    assert {"levels.png", "waterfall.force.png"} <= {file.name for file in tmp_path.iterdir()}
    assert main(["plot", str(tmp_path), "--highest", "100"]) == 2
    assert "this is the folder of a sweep" in capsys.readouterr().err


def test_what_is_no_folder_of_results_is_refused(tmp_path, capsys):
    assert main(["plot", str(tmp_path)]) == 2
    assert "holds no results" in capsys.readouterr().err
    missing = tmp_path / "missing"
    assert main(["plot", str(missing)]) == 2
    assert f"there is no folder {missing}" in capsys.readouterr().err
    assert not missing.exists()


def test_a_file_is_no_folder(tmp_path, capsys):
    file = tmp_path / "results.csv"
    file.write_text("time\n0\n")
    assert main(["plot", str(file)]) == 2
    assert f"{file} is a file: plot takes the folder that it is in" in capsys.readouterr().err

"""Runs with housings in C that are wrong: told before the run, and no success."""

import json

import pytest
from support.foreign.c_housing import DOFS, c_housing_fmu

import herringbone as hb
from herringbone.commands import main as cli
from herringbone.running.reporting.summary import summary_text

SPRING, BETWEEN = 1.5e8, 8e7
"""Along the shafts [N/m], the softest direction: of each seat, and between two."""


def run(capsys, folder, file, t_end):
    """Exit code and summary."""
    command = ["run", "gearbox", "--t-end", t_end, "--json", "-o", str(folder / "out")]
    code = cli.main([*command, "--replace", f"modal_housing={file}"])
    return code, json.loads(capsys.readouterr().out)


def rows(capsys, file, code=0):
    assert cli.main(["check", str(file), "--as", "housing", "--json"]) == code
    found = json.loads(capsys.readouterr().out)
    return {row["test"]: row for row in found["tests"]}


def test_size_of_the_compliance(capsys, tmp_path):
    """A force moves its seat by (k + c) / (k (k + 2 c)); in mm that is a thousand times as much."""
    right = rows(capsys, c_housing_fmu(tmp_path))["compliance"]
    exact = (SPRING + BETWEEN) / (SPRING * (SPRING + 2.0 * BETWEEN))
    assert right["verdict"] == "holds"
    assert float(right["measured"].split()[2]) == pytest.approx(exact, rel=0.01)
    (tmp_path / "mm").mkdir()
    mm = rows(capsys, c_housing_fmu(tmp_path / "mm", ("PLACE=1e3", "SPEED=1e3")))["compliance"]
    assert mm["verdict"] == "remark"
    assert float(mm["measured"].split()[2]) == pytest.approx(1e3 * exact, rel=0.01)
    assert "check units (m, m/s, N)" in mm["measured"]


def test_displacements_in_mm_are_named_where_the_run_diverges(capsys, caplog, tmp_path):
    file = c_housing_fmu(tmp_path, ("PLACE=1e3", "SPEED=1e3"))
    code, found = run(capsys, tmp_path, file, "0.002")
    assert (code, found["outcome"]) == (1, "diverged")
    words = "the static compliance of its seats is at most 4.9"
    assert words in found["message"]
    assert words in caplog.messages[0]


def test_a_housing_that_makes_energy_is_no_success(capsys, caplog, tmp_path):
    """Forces act backwards; in 1 ms nothing has grown beyond bounds."""
    file = c_housing_fmu(tmp_path, ("FORCE=-1.0",))
    code, found = run(capsys, tmp_path, file, "0.001")
    assert (code, found["outcome"]) == (1, "completed_part_makes_energy")
    assert found["culprit"] == "modal_housing"
    assert "modal_housing makes energy" in found["message"]
    assert "breaks the contract of housings: static compliance" in caplog.messages[0]
    short = {"replace_parts": {"modal_housing": file}, "t_end": 1e-4}
    result = hb.run("gearbox", **short)
    assert not result.outcome.completed
    result = hb.run("gearbox", probe=False, **short)
    assert result.outcome.completed
    (line,) = (note for note in result.info.notes if "not tested as housing" in note)
    assert line.startswith(str(file))
    assert result.outcome.reached_end


CROSSING = 0.01
"""To twice which limits are found, by bisection."""


def test_a_right_one_completes(capsys, caplog, tmp_path):
    code, found = run(capsys, tmp_path, c_housing_fmu(tmp_path), "0.001")
    assert (code, found["outcome"]) == (0, "completed")
    assert not any("c_housing.fmu" in line for line in [*caplog.messages, *found["notes"]])


def test_check_knows_the_variables_of_a_housing(capsys, tmp_path):
    file = c_housing_fmu(tmp_path)
    assert cli.main(["check", str(file)]) == 0
    assert f"'herringbone check {file} --as housing'" in capsys.readouterr().out


def test_units_of_a_housing_without_are_si(tmp_path):
    """As the table of the seats, the lines of the spectrum have theirs."""
    names = [f"{seat}.{q}_{axis}" for seat, axis in DOFS for q in "fsv"]
    file = c_housing_fmu(tmp_path, units=dict.fromkeys(names, ""))
    result = hb.run("gearbox", replace_parts={"modal_housing": file}, t_end=2e-3)
    assert result.units["modal_housing.wheel_left.v_y"] == "m/s"
    assert result.units["modal_housing.wheel_left.s_y"] == "m"
    lines = summary_text(result).splitlines()
    (line,) = (line for line in lines if line.startswith("seat velocity:"))
    assert " mm/s at " in line


def test_stability_of_one_that_saves_no_state(capsys, tmp_path):
    """Its limits are those of the same housing that saves its state: jacobi repeats no step."""
    limits = []
    for saves in (False, True):
        folder = tmp_path / str(saves)
        folder.mkdir()
        file = c_housing_fmu(folder, ("SAVES",) if saves else (), saves=saves)
        command = ["stability", "gearbox", "--replace", f"modal_housing={file}", "--json"]
        assert cli.main([*command, "--algorithm", "jacobi:order=2"]) == 0
        found = json.loads(capsys.readouterr().out)
        assert ("modal_housing" in found["foreign_instances"]) != saves
        (algorithm,) = found["algorithms"]
        assert algorithm["promised"]
        limits.append(algorithm["limit"])
    assert limits[0] == pytest.approx(limits[1], rel=CROSSING)

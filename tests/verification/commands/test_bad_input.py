"""Bad input through the command line: one clear line, a non-zero exit code, results kept."""

import json
import math
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import fmpy
import pandas as pd
import pytest
from support.gearing.gear_mesh import write_table

from herringbone.commands.main import main
from herringbone.core.places.paths import component_folder

KINDS = ("native", "python", "in-process")
STRANGER = Path(__file__).parents[2] / "fmus" / "strange_housing.py"


@pytest.fixture
def refused(capsys, tmp_path, monkeypatch):
    """Run the test rig, or another system, with arguments that must be refused; gives the line."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments, system="test_rig", fmu="in-process"):
        assert main(["run", str(system), "--t-end", "0.001", "--fmu", fmu, *arguments]) == 2
        out, err = capsys.readouterr()
        assert out == ""
        assert len(err.splitlines()) == 1
        assert err.startswith("herringbone: ")
        assert not (tmp_path / "results").exists()
        return err

    return run


@pytest.fixture
def without_pictures(monkeypatch):
    """Drawing takes longer than these runs, and runs that fail by their step are drawn."""
    monkeypatch.setattr("herringbone.plotting.write_pictures", lambda result, folder: [])


@pytest.mark.parametrize("fmu", KINDS)
@pytest.mark.parametrize(
    ("assignment", "said"),
    [
        ("nope.stiffness=1", "system 'test_rig' has no part 'nope'; it has: bench_controller,"),
        (
            "gear_mesh.nope=1",
            "there is no variable 'nope'; 'herringbone list gear_mesh' shows them",
        ),
        ("gear_mesh.backlash=wide", "gear_mesh.backlash = 'wide': it takes a number"),
        ("gear_mesh.backlash=nan", "gear_mesh.backlash = nan m: it must be finite"),
        ("gear_mesh.pinion.inertia=-1", "gear_mesh.pinion.inertia = -1 kg.m2: it must lie between"),
        ("gear_mesh.micro_step=0", "gear_mesh.micro_step = 0 s: it must lie between 1e-09 and"),
        ("gear_mesh.stiffness_table=3", "gear_mesh.stiffness_table = 3.0: it takes a file name"),
        ("gear_mesh.stiffness_table=/no.csv", "there is no file /no.csv; give an absolute path"),
        ("bench_controller.cycle=/no.csv", "there is no file /no.csv; give an absolute path"),
    ],
)
def test_parameters(refused, fmu, assignment, said):
    assert said in refused("--set", assignment, fmu=fmu)


def secant(phase, load):
    """Periodic in the phase, positive, softer under load."""
    return 8e8 + 5e7 * math.cos(2 * math.pi * phase)


def with_end(file):
    """The table with phase 1, where the stiffness is 1 % off."""
    lines = file.read_text().splitlines()
    for side in ("left", "right"):
        for load in (10.0, 1e5):
            lines.append(f"{side},{load},1.0,{1.01 * secant(0.0, load)}")
    file.write_text("\n".join(lines) + "\n")


def edited(old, new):
    return lambda file: file.write_text(file.read_text().replace(old, new))


TABLES = {
    "not periodic": (with_end, "side left: not periodic: stiffness at phase 1 differs"),
    "NaN": (edited("850000000.0", "nan"), "line 3: stiffness = 'nan' is not a finite number"),
    "negative": (edited("850000000.0", "-8.5e8"), "stiffness -8.5e+08 N/m at load 10 N, phase 0"),
    "wrong unit": (edited("N/m", "N/mm"), "column 'stiffness' has unit 'N/mm'"),
    "no unit": (edited("# units: load N, phase 1, stiffness N/m\n", ""), "the first line must be"),
    "one row less": (edited("left,10.0,0.0,850000000.0\n", ""), "are no full grid"),
}


@pytest.mark.parametrize("fmu", KINDS)
@pytest.mark.parametrize("defect", TABLES)
def test_stiffness_table(refused, tmp_path, fmu, defect):
    file = write_table(tmp_path / "table.csv", secant)
    change, said = TABLES[defect]
    change(file)
    line = refused("--set", f"gear_mesh.stiffness_table={file}", fmu=fmu)
    assert said in line
    assert f"gear_mesh: {file}" in line


@pytest.mark.parametrize("fmu", KINDS)
def test_housing_without_a_seat(refused, tmp_path, fmu):
    lines = (
        (component_folder("modal_housing") / "resources" / "shapes.csv").read_text().splitlines()
    )
    file = tmp_path / "shapes.csv"
    file.write_text("\n".join(line for line in lines if "wheel_right" not in line) + "\n")
    line = refused("--set", f"modal_housing.shapes={file}", fmu=fmu)
    assert str(file) in line
    assert "wheel_right" in line


SYSTEM = """
connections = [{}]
[parts]
coupling = {{ component = "shaft_coupling" }}
other = {{ component = "shaft_coupling" }}
motor = {{ component = "drive_motor" }}
load = {{ component = "load_motor" }}
control = {{ component = "bench_controller" }}
"""


@pytest.mark.parametrize("fmu", KINDS)
@pytest.mark.parametrize(
    ("connections", "said"),
    [
        ('["motor.flange", "coupling.nope"]', "coupling has no variable or port 'nope'"),
        ('["motor.nope", "coupling.flange_a"]', "motor has no variable or port 'nope'"),
        ('["nope.flange", "coupling.flange_a"]', "has no part 'nope'; it has: coupling,"),
        (
            '["control.torque_setpoint", "motor.speed_setpoint"]',
            "'control.torque_setpoint' -> 'motor.speed_setpoint': units differ, 'N.m' and 'rad/s'",
        ),
        (
            '["motor.flange", "coupling.flange_a"], ["motor.flange", "other.flange_a"]',
            "input 'motor.flange.tau' has two sources: 'coupling.flange_a.tau' and "
            "'other.flange_a.tau'",
        ),
        ('["motor.flange", "load.flange"]', "(body to body); insert a shaft coupling"),
        ('["coupling.flange_a", "other.flange_a"]', "(element to element); put a body"),
    ],
)
def test_connections(refused, tmp_path, fmu, connections, said):
    (tmp_path / "system.toml").write_text(SYSTEM.format(connections))
    assert said in refused("--start", "rest", system=tmp_path, fmu=fmu)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("connections = [", "cannot read"),
        ("nope = 1", "unknown key nope"),
        ('[parts.a]\ncomponent = "nope"', "there is no component 'nope'"),
        ('[parts.a]\nfmu = "no.fmu"', "there is no file"),
        ('[parts.a]\nsystem = "nope"', "there is no system 'nope'"),
    ],
)
def test_system_file(refused, tmp_path, text, said):
    (tmp_path / "system.toml").write_text(text)
    assert said in refused("--start", "rest", system=tmp_path)


@pytest.mark.parametrize(
    ("option", "said"),
    [
        ("--step=0", "step = 0 s: it must be positive and finite"),
        ("--step=-1e-5", "step = -1e-05 s: it must be positive and finite"),
        ("--step -1e-5", "step = -1e-05 s: it must be positive and finite"),
        ("--t-end -.5", "t_end = -0.5 s: it must be positive and finite"),
        ("--record-step -inf", "record_step = -inf s: it must be positive and finite"),
        ("--step=nan", "step = nan s: it must be positive and finite"),
        ("--t-end=inf", "t_end = inf s: it must be positive and finite"),
        ("--t-end=0", "t_end = 0 s: it must be positive and finite"),
        ("--step=1e-30", "in steps of 1e-30 s makes 1e+27 macro steps; use a longer step or a"),
        ("--t-end=1e30", "t_end = 1e+30 s in steps of 5e-05 s makes 2e+34 macro steps; use a"),
        ("--t-end=1e6 --record-step=1e-6 --step=1e-6", "1000000000001 records of "),
        ("--t-end=1e6 --record-step=1e-6 --step=1e-6", "use a longer record_step (--record-step)"),
        ("--step=0.1", "t_end = 0.001 s is shorter than one step of 0.1 s"),
        ("--record-step=1", "record_step = 1 s is longer than the run, t_end = 0.001 s"),
        ("--record-step=nan", "record_step = nan s: it must be positive and finite"),
        ("--scene=nope", "there is no scene 'nope'; test_rig has: loaded, runup, separation"),
        ("--algorithm=nope", "there is no algorithm 'nope'; there are: auto, jacobi,"),
        ("--algorithm=jacobi:nope=1", "jacobi has no option 'nope'; it has: order"),
        ("--algorithm=jacobi:order=7", "jacobi: order=7; it must be 0, 1 or 2"),
        ("--algorithm=jacobi:order=two", "jacobi:order=two"),
        ("--tolerance=2", "tolerance = 2: it must lie between 1e-08 and 1"),
        ("--tolerance=0", "tolerance = 0: it must lie between 1e-08 and 1"),
        (
            "--slow=nope=2",
            "slow: nope=2: the system has no part 'nope'; it has: bench_controller, drive_motor, "
            "drive_coupling, load_coupling, load_motor, gearbox.gear_mesh, "
            "gearbox.bearing_supports, gearbox.modal_housing; drive_motor, load_motor, "
            "gearbox.gear_mesh, gearbox.modal_housing can be slow",
        ),
        ("--slow=drive_motor", "--slow drive_motor: it must be INSTANCE=N,..."),
        ("--slow=drive_motor=2.5", "--slow drive_motor=2.5: it must be a whole number of steps"),
        ("--slow=load_coupling=2", "load_coupling has direct feedthrough; only bodies can be slow"),
        ("--start=nope", "start = 'nope'; it must be one of equilibrium, ramp, rest"),
        ("--fmu=nope", "fmu = 'nope'; it must be one of auto, native, python, in-process"),
        ("--replace=nope=x.fmu", "has no part 'nope'"),
        ("--replace=modal_housing=no.fmu", "modal_housing: there is no file no.fmu"),
        ("--replace=modal_housing=.", "modal_housing: . is a folder; give an .fmu file"),
        (f"--housing={__file__}", "'herringbone housing import' makes the"),
    ],
)
def test_options(refused, option, said):
    assert said in refused(*option.split())


def test_check_of_a_folder(tmp_path, capsys):
    assert main(["check", str(tmp_path)]) == 2
    assert capsys.readouterr().err == f"herringbone: {tmp_path} is a folder; give an .fmu file\n"


def test_file_that_cannot_be_exported(capsys):
    assert main(["export", "gearbox", "-o", "/proc/x.ssp"]) == 2
    assert "cannot write /proc/x.ssp: " in capsys.readouterr().err


def test_unknown_system(refused):
    assert "'nope': give one of back_to_back, boosted_axle, e_axle" in refused(system="nope")


XML = (
    '<?xml version="1.0"?>{before}<fmiModelDescription fmiVersion="{version}" modelName="m" '
    'guid="0"><CoSimulation modelIdentifier="m"/><ModelVariables><ScalarVariable '
    'name="pinion_left.f_x" valueReference="0" causality="input"><Real start="0"/></ScalarVariable>'
    "</ModelVariables><ModelStructure/></fmiModelDescription>"
)
BINARY = f"binaries/{fmpy.platform}/m{fmpy.sharedLibraryExtension}"


@pytest.mark.parametrize(
    ("names", "before", "version", "said"),
    [
        ((), "", "2.0", f"has no binary for this platform ({BINARY})"),
        ((BINARY,), "", "1.0", "is an FMI 1.0 unit; FMI 2.0 or 3.0 for co-simulation is needed"),
        ((BINARY, "../out"), "", "2.0", "entry '../out' would be written outside its folder"),
        ((BINARY,), '<!DOCTYPE m [<!ENTITY e "x">]>', "2.0", "declares a DOCTYPE or an entity"),
        ((BINARY,), "", "2.0", "does not instantiate"),
    ],
)
def test_fmu_files(refused, tmp_path, names, before, version, said):
    file = tmp_path / "x.fmu"
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("modelDescription.xml", XML.format(before=before, version=version))
        for name in names:
            archive.writestr(name, b"")
    line = refused(f"--replace=modal_housing={file}")
    assert said in line
    assert str(file) in line
    assert not (tmp_path.parent / "out").exists()


def test_no_zip(refused, tmp_path):
    file = tmp_path / "x.fmu"
    file.write_text("not a zip")
    assert f"{file} is not an FMU" in refused(f"--replace=modal_housing={file}")


@pytest.mark.parametrize("folder", ["file", "file/below", "/proc/below"])
def test_folder_that_cannot_be_written(refused, tmp_path, folder):
    (tmp_path / "file").touch()
    line = refused("-o", folder)
    assert f"cannot write to {folder}: " in line
    assert "choose another folder with -o" in line
    assert ("nothing can be made in /proc" in line) == folder.startswith("/proc")


def ended_early(folder, capsys, *arguments, outcome, fmu):
    """A run that ends early: the line, the kept table and the summary."""
    assert main(["run", "test_rig", "--fmu", fmu, "-o", str(folder), *arguments]) == 1
    err = capsys.readouterr().err
    assert len(err.splitlines()) == 1
    assert err.startswith(f"herringbone: {outcome}: ")
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["outcome"] == outcome
    table = pd.read_csv(folder / "results.csv", comment="#")
    assert table.notna().all(axis=None)
    assert table["time"].iloc[-1] <= summary["t_reached"] < summary["t_end"]
    return err, table, summary


@pytest.mark.parametrize("fmu", KINDS)
def test_step_beyond_the_limit(tmp_path, capsys, fmu):
    """Order 2 is unstable at 50 us; the values pass 1e30 after some hundred steps."""
    options = ("--step", "5e-5", "--algorithm", "jacobi:order=2")
    line, table, summary = ended_early(tmp_path, capsys, *options, outcome="diverged", fmu=fmu)
    how = "(grows beyond all bounds|is not finite)"
    assert re.search(f"{summary['culprit']} {how} at {summary['t_reached']:g} s", line)
    assert "use a step below 5e-05 s or an algorithm with a higher limit" in line
    assert len(table) > 100


UNSTABLE = ["run", "test_rig", "--t-end=0.005", "--step=1e-4", "--algorithm=jacobi"]
"""Twice the limit of order 2: ten orders of magnitude in 50 steps, but nothing overflows."""


def test_unstable_to_the_end(tmp_path, capsys):
    """The run is no success, though it reaches its end: all files, but no figures."""
    assert main([*UNSTABLE, "--fmu=in-process", "-o", str(tmp_path)]) == 1
    out, err = capsys.readouterr()
    assert len(err.splitlines()) == 1
    summary = json.loads((tmp_path / "summary.json").read_text())
    bond, time = summary["culprit"], summary["energy"]["time"]
    assert (summary["outcome"], summary["t_reached"]) == ("unstable", 0.005)
    assert bond.startswith("gearbox.bearing_supports.")
    assert err.startswith(
        f"herringbone: unstable: ran to the end, but the coupling is unstable from {time:.4g} s, "
        f"most of all at {bond}: use a step below 0.0001 s or an algorithm with a higher limit"
    )
    assert "Why unstable" in out
    assert "No figures" in out
    assert "Pinion speed" not in out
    assert out == (tmp_path / "summary.txt").read_text() + "\n"
    assert all(Path(file).is_file() for file in summary["results"])
    assert len(pd.read_csv(tmp_path / "results.csv", comment="#")) == 51


def test_results_are_written_before_the_diagnosis(tmp_path, monkeypatch):
    there = []

    def diagnose(*arguments):
        del arguments
        there.extend(sorted(file.name for file in tmp_path.iterdir()))

    monkeypatch.setattr("herringbone.running.prepared_runs.diagnose", diagnose)
    main([*UNSTABLE, "--fmu=in-process", "-o", str(tmp_path)])
    assert {"overview.png", "results.csv", "summary.json", "summary.txt"} <= set(there)


@pytest.mark.usefixtures("without_pictures")
def test_a_shortened_step_is_noted(tmp_path, capsys):
    command = ["run", "test_rig", "--t-end=1.5e-4", "--fmu=in-process", "--json"]
    main([*command, "--overwrite", "-o", str(tmp_path), "--step=4e-5"])
    summary = json.loads(capsys.readouterr().out)
    assert summary["communication_step"] == pytest.approx(3.75e-5)
    assert any("step = 4e-05 s: shortened to 3.75e-05 s" in note for note in summary["notes"])
    main([*command, "--overwrite", "-o", str(tmp_path), "--step=3.75e-5"])
    notes = json.loads(capsys.readouterr().out)["notes"]
    assert not any("shortened" in note for note in notes)


@pytest.fixture(scope="module")
def stranger(tmp_path_factory):
    """Builds hand-written FMUs; changes of the source as (old, new) pairs, class names differ."""

    def build(name="StrangeHousing", *changes):
        folder = tmp_path_factory.mktemp("fmu")
        text = STRANGER.read_text().replace("StrangeHousing", name)
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        script = folder / f"{name.lower()}.py"
        script.write_text(text)
        command = [sys.executable, "-m", "pythonfmu", "build", "-f", str(script), "-d", str(folder)]
        subprocess.run(command, check=True, capture_output=True)
        return folder / f"{name}.fmu"

    return build


@pytest.mark.usefixtures("without_pictures")
def test_foreign_housing_runs(tmp_path, capsys, stranger):
    file = stranger()
    arguments = ["run", "test_rig", "--t-end", "0.001", "--json", "-o", str(tmp_path)]
    assert main([*arguments, "--replace", f"modal_housing={file}"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["model"]["gearbox.modal_housing"] == str(file)
    notes = [note for note in summary["notes"] if "gearbox.modal_housing" in note]
    assert any("it is stepped over 0.04 s before the start" in note for note in notes)
    assert any("and 35 more between these parts: a unit is not declared" in note for note in notes)
    assert any("a body by trial steps; it cannot repeat a step" in note for note in notes)
    table = pd.read_csv(tmp_path / "results.csv", comment="#")
    assert table["gearbox.modal_housing.pinion_left.v_y"].abs().max() > 0.0


@pytest.mark.usefixtures("without_pictures")
def test_foreign_housing_is_tested(tmp_path, capsys, stranger):
    """One that feeds power into the vibration runs, with a note; the check fails."""
    assert main(["check", str(stranger("Fair")), "--as", "housing"]) == 0
    out = capsys.readouterr().out
    assert re.search(r"passivity +holds +no negative work", out)
    assert out.endswith("all tests hold\n")
    file = stranger("Active", ("DAMPING = 50.0, 1e9, 1e4", "DAMPING = 50.0, 1e9, -1e5"))
    assert main(["check", str(file), "--as", "housing"]) == 1
    assert re.search(r"passivity +FAILS +-[\d.]+ of the highest work", capsys.readouterr().out)
    arguments = ["run", "test_rig", "--t-end", "1e-4", "--json", "-o", str(tmp_path)]
    main([*arguments, "--replace", f"modal_housing={file}"])
    notes = json.loads(capsys.readouterr().out)["notes"]
    assert any(f"{file} breaks the contract of housings: passivity: -" in note for note in notes)


def test_foreign_housing_without_state_has_no_adaptive_step(refused, stranger):
    """With `--tolerance` alone its step is found by runs."""
    replace = f"--replace=modal_housing={stranger('NoState')}"
    line = refused("--algorithm=li:tolerance=1e-3", replace)
    assert "gearbox.modal_housing cannot save and restore its state" in line


def test_foreign_housing_has_no_reference(refused, stranger):
    line = refused("--reference", f"--replace=modal_housing={stranger('NoReference')}")
    assert "gearbox.modal_housing is a foreign FMU" in line
    assert "no monolithic reference" in line


def test_foreign_housing_with_a_missing_seat(refused, stranger):
    seats = '("pinion_left", "pinion_right", "wheel_left", "wheel_right")'
    file = stranger("ThreeSeats", (seats, '("pinion_left", "pinion_right", "wheel_left")'))
    line = refused(f"--replace=modal_housing={file}")
    assert "gearbox.modal_housing has no variable or port 'wheel_right'; it has the ports" in line
    assert "or leave the connection out of your system.toml" in line


FAILURES = {
    "Nan": ("return True", "self.pinion_left.s_y = float('nan'); return True", "diverged"),
    "Inf": ("return True", "self.pinion_left.v_y = float('inf'); return True", "diverged"),
    "Refuses": ("return True", "return False", "part_failed"),
    "Raises": ("return True", "raise ValueError('too far')", "part_failed"),
}


@pytest.mark.usefixtures("without_pictures")
@pytest.mark.parametrize("name", FAILURES)
def test_foreign_housing_fails_during_the_run(tmp_path, capsys, stranger, name):
    old, new, outcome = FAILURES[name]
    late = f"if current_time > 4e-4:\n            {new}\n        return True"
    file = stranger(f"Housing{name}", (old, late))
    line, table, summary = ended_early(
        tmp_path, capsys, f"--replace=modal_housing={file}", outcome=outcome, fmu="in-process"
    )
    assert summary["culprit"].startswith("gearbox.modal_housing")
    assert "gearbox.modal_housing" in line
    assert "at 0.0004" in line
    if name == "Raises":
        assert "too far" in line
    assert table["time"].iloc[-1] >= 3.8e-4

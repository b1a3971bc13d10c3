"""Bad input through the command line: one clear line, a non-zero exit code."""

import math
import os
import sys
import zipfile

import fmpy
import pytest
from support.gearing.gear_mesh import write_table

from herringbone.commands.main import main
from herringbone.core.places.paths import component_folder

KINDS = ("native", "python", "in-process")


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
        ("--t-end=1e6 --record-step=1e-6 --step=1e-6", "use a longer --record-step or a"),
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
    line = refused(f"--replace=load_motor={file}")  # what a housing lacks is told before
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


@pytest.mark.parametrize("folder", [b"out\xff", b"out\xff/below"])
def test_results_go_into_no_folder_that_they_cannot_name(tmp_path, refused, folder):
    """A run was computed to its end, and its results could not be loaded."""
    line = refused("-o", os.fsdecode(folder))
    assert r"the name 'out\udcff' is not UTF-8; choose another folder" in line
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(sys.platform != "linux", reason="names are any bytes on Linux alone")
def test_a_file_that_results_cannot_name(tmp_path, refused):
    file = write_table(tmp_path / os.fsdecode(b"t\xff.csv"), secant)
    line = refused("--set", f"gear_mesh.stiffness_table={file}", "-o", "out")
    assert r"t\udcff.csv' is not UTF-8; rename it" in line
    assert not (tmp_path / "out").exists()

"""The command line: help, list, version, build, check, export, exit codes."""

import gc
import os
import subprocess
import sys
import zipfile

import pytest

import herringbone
from herringbone.commands import main as main_module
from herringbone.commands import output
from herringbone.commands.main import BAD_INPUT, EXIT_CODES, main
from herringbone.components.registry import COMPONENTS
from herringbone.core import HerringboneError, OutcomeKind
from herringbone.core.places.paths import CACHE_VARIABLE


def shown(capsys, *arguments, code=0):
    assert main(arguments) == code
    return capsys.readouterr().out


def ended(capsys, *arguments):
    """Exit code, output and errors of what argparse ends itself."""
    with pytest.raises(SystemExit) as error:
        main(arguments)
    return error.value.code, *capsys.readouterr()


def refused(capsys, *arguments):
    """The one line that a refused command leaves."""
    assert main(arguments) == BAD_INPUT
    out, err = capsys.readouterr()
    assert out == ""
    assert len(err.splitlines()) == 1
    return err


def test_a_wrong_option_is_told_by_its_command(capsys):
    code, _, err = ended(capsys, "run", "test_rig", "--algoritm", "li")
    assert code == BAD_INPUT
    assert "did you mean --algorithm?" in err
    assert err.endswith("see 'herringbone run --help'\n")
    assert len(err.splitlines()) == 1


@pytest.mark.parametrize(
    ("arguments", "meant"),
    [
        (("list", "gear_mseh"), "gear_mesh"),
        (("list", "test_rgi"), "test_rig"),
        (("run", "test_rgi"), "test_rig"),
        (("run", "test_rig", "--scene=runp"), "runup"),
    ],
)
def test_a_wrong_name_is_answered_by_what_it_may_mean(capsys, arguments, meant):
    assert f"did you mean {meant}?" in refused(capsys, *arguments)


@pytest.mark.parametrize(
    ("arguments", "unit"),
    [
        (("run", "test_rig", "--step", "40us"), "communication step size in s"),
        (("sweep", "test_rig", "--t-end", "2s"), "duration of each run in s"),
    ],
)
def test_a_refused_number_is_told_its_unit(capsys, arguments, unit):
    code, _, err = ended(capsys, *arguments)
    assert code == BAD_INPUT
    assert f"it takes a number alone: {unit}" in err


def test_list_shows_a_system(capsys):
    text = shown(capsys, "list", "test_rig")
    for told in (
        "gearbox.gear_mesh",
        "drive_motor.flange",
        "bench_controller.speed_setpoint",
        "runup",
    ):
        assert told in text


def test_list_shows_a_system_one_scene_of_which_is_broken(tmp_path, capsys):
    (tmp_path / "scenes").mkdir()
    file = tmp_path / "system.toml"
    file.write_text('name = "mine"\n[parts]\na = { component = "rotating_inertia" }\n')
    (tmp_path / "scenes" / "good.toml").write_text('description = "a good one"\n')
    (tmp_path / "scenes" / "bad.toml").write_text("tend = 1\n")
    for given in (tmp_path, file):
        text = shown(capsys, "list", str(given))
        assert "good  a good one" in text
        assert "bad   cannot be run: " in text
        assert "--speed   none: no part of mine declares a speed set point" in text


@pytest.mark.parametrize("command", ["list", "build", "check", "run", "export"])
def test_help(capsys, command):
    code, out, _ = ended(capsys, "--help")
    assert code == 0
    assert f"    {command} " in out
    code, out, _ = ended(capsys, command, "--help")
    assert code == 0
    assert out.startswith(f"usage: herringbone {command}")


def test_version(capsys):
    assert ended(capsys, "--version") == (0, herringbone.__version__ + "\n", "")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((), "the following arguments are required: COMMAND"),
        (("frobnicate",), "invalid choice: 'frobnicate'"),
        (("export",), "the following arguments are required: system"),
        (("run", "test_rig", "--step", "abc"), "--step: invalid float value: 'abc'"),
        (("run", "test_rig", "--frobnicate"), "unrecognized arguments: --frobnicate"),
    ],
)
def test_wrong_arguments_are_one_line(capsys, arguments, said):
    code, out, err = ended(capsys, *arguments)
    assert (code, out) == (BAD_INPUT, "")
    assert len(err.splitlines()) == 1
    assert said in err
    assert "--help'" in err


def test_list(capsys):
    out = shown(capsys, "list")
    for name in (*COMPONENTS, "gearbox", "test_rig", "loaded", "runup", "separation", "jacobi"):
        assert f"  {name}" in out


@pytest.mark.parametrize("name", COMPONENTS)
def test_list_component(capsys, name):
    lines = shown(capsys, "list", name).splitlines()
    declaration = COMPONENTS[name].declaration
    assert lines[0] == f"{name}: {declaration.description}"
    rows = {line.split()[0]: line for line in lines if line.startswith("  ")}
    assert set(rows) == {v.name for v in (*declaration.variables, *declaration.texts)}
    for v in declaration.variables:
        assert rows[v.name].split(v.description)[0].split()[-1] == v.unit


@pytest.mark.parametrize("command", ["list", "build"])
def test_unknown_component(capsys, command):
    assert "no component 'nope'; there are: gear_mesh" in refused(capsys, command, "nope")


@pytest.mark.parametrize(
    ("option", "item", "form"),
    [
        ("--set", "gear_mesh.backlash", "INSTANCE.VARIABLE=VALUE"),
        ("--set", "=1", "INSTANCE.VARIABLE=VALUE"),
        ("--set", "gear_mesh.backlash=", "INSTANCE.VARIABLE=VALUE"),
        ("--set", "backlash=1", "INSTANCE.VARIABLE"),
        ("--replace", "modal_housing", "INSTANCE=FILE.fmu"),
    ],
)
def test_assignments_say_their_form(capsys, option, item, form):
    assert f"must be {form}\n" in refused(capsys, "run", "test_rig", option, item)


def test_exit_codes_cover_all_outcomes():
    assert set(EXIT_CODES) == set(OutcomeKind)
    zero = [kind for kind, code in EXIT_CODES.items() if code == 0]
    assert zero == [OutcomeKind.COMPLETED, OutcomeKind.ENDED]


def test_debug_shows_the_traceback(capsys):
    assert main(["--debug", "run", "nope"]) == BAD_INPUT
    assert "Traceback" in capsys.readouterr().err


def test_build(capsys, tmp_path):
    out = shown(capsys, "build", "shaft_coupling", "-o", str(tmp_path / "fmus"))
    file = tmp_path / "fmus" / "shaft_coupling.fmu"
    assert out.split() == [str(file)]
    assert "modelDescription.xml" in zipfile.ZipFile(file).namelist()


def test_check(capsys, python_fmus):
    file = str(python_fmus["shaft_coupling"])
    said = shown(capsys, "check", file)
    assert said.startswith(f"{file}: no problems\n  by trial steps of 10 us: an element\n")
    assert "  d(flange_a.tau)/d(flange_b.phi) = 60000\n" in said


def test_check_of_no_fmu(capsys, tmp_path):
    file = tmp_path / "x.fmu"
    assert refused(capsys, "check", str(file)) == f"herringbone: there is no file {file}\n"
    file.write_text("not a zip")
    assert shown(capsys, "check", str(file), code=1).startswith(f"{file} is not an FMU")


def test_export(capsys, tmp_path):
    file = tmp_path / "rig.ssp"
    assert shown(capsys, "export", "test_rig", "-o", str(file)) == f"{file}\n"
    assert "SystemStructure.ssd" in zipfile.ZipFile(file).namelist()


def test_export_of_bad_input(capsys, tmp_path):
    assert "there is no system 'nope'" in refused(capsys, "export", "nope")
    wrong = str(tmp_path / "rig.zip")
    assert "must end in .ssp" in refused(capsys, "export", "test_rig", "-o", wrong)


def test_modal_data_belong_to_the_test_of_a_housing(capsys):
    said = refused(capsys, "check", "housing.fmu", "--against", "data")
    assert "--against belongs to the test of a housing; add --as housing" in said


def test_what_trials_told_is_forgotten_where_that_is_asked(capsys, tmp_path, monkeypatch):
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    for kind in ("tried/limits", "answers", "kernels"):
        (tmp_path / kind).mkdir(parents=True)
    refused(capsys, "stability", "nowhere")
    assert (tmp_path / "tried" / "limits").is_dir()
    refused(capsys, "stability", "nowhere", "--fresh")
    left = {place.name for place in tmp_path.iterdir()}
    assert "tried" not in left
    assert "kernels" in left


def test_cycles_are_seldom_searched_while_a_command_runs(monkeypatch, capsys):
    def command(_):
        found.append(gc.get_threshold())
        raise HerringboneError("no")

    found = []
    monkeypatch.setattr("herringbone.commands.listing.command.run", command)
    main_module._parser.cache_clear()
    before = gc.get_threshold()
    gc.set_threshold(700, 10, 10)
    try:
        assert "no" in refused(capsys, "list")
        assert found == [output._SELDOM]
        assert gc.get_threshold() == (700, 10, 10)
    finally:
        gc.set_threshold(*before)
        main_module._parser.cache_clear()


@pytest.mark.skipif(sys.platform == "win32", reason="a current folder cannot be removed there")
def test_a_current_folder_that_is_gone(capsys, monkeypatch, tmp_path):
    (tmp_path / "gone").mkdir()
    monkeypatch.chdir(tmp_path / "gone")
    (tmp_path / "gone").rmdir()
    line = refused(capsys, "list")
    assert line == "herringbone: the current folder is gone; cd to another\n"


@pytest.mark.parametrize(
    "call", [["-m", "herringbone", "list"], ["-c", "import herringbone as hb; hb.run('test_rig')"]]
)
def test_docstrings_are_needed(call):
    """FMUs are documented by them; without, an attribute of None was missing."""
    environment = {**os.environ, "PYTHONOPTIMIZE": "2", "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, *call]
    found = subprocess.run(command, check=False, capture_output=True, text=True, env=environment)
    *before, line = found.stderr.splitlines()
    assert line.endswith("run it without -OO and PYTHONOPTIMIZE=2")
    assert bool(before) == ("-c" in call)
    assert found.returncode == (1 if "-c" in call else BAD_INPUT)

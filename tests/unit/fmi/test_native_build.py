"""Building native FMUs: reproducible, cached, small; who asks for what, and gets it."""

import fcntl
import importlib.util
import threading
import zipfile

import fmpy
import pytest
from fmpy.model_description import read_model_description

from herringbone.commands.main import main
from herringbone.core import FmuError, ParameterError
from herringbone.core.places.paths import CACHE_VARIABLE, component_folder
from herringbone.fmi import kind
from herringbone.fmi.native import PLATFORMS, build, build_native_fmus, compiler, own_platform
from herringbone.fmi.native.model import registered_model
from herringbone.fmi.validation import validation_problems
from herringbone.running.exporting.export import build_fmus

OWN = own_platform()
ASIDE = ("resources/", "documentation/", "extra/")
"""What does not count: data, pages, reference results."""
WITH_SINGLE_TEETH = 342_500
"""Bytes of the gear mesh with all platforms, which misses the 300 000 of other FMUs: the law of
single teeth takes 14 kB per platform. Outputs that are made when a host asks for them take 0.7 kB
of the wrapper for FMI 3.0 per platform; states on which outputs depend, for hosts that linearise,
and that a table between phases without stiffness does not pull, 0.6 kB in all; steps that leave all
as it was if they fail, and directional derivatives of the start, 1.4 kB per platform; the contact
ratio, by which teeth enter on either end of their path, 0.6 kB in all."""


def test_two_builds_are_identical(native_fmus, tmp_path, monkeypatch):
    monkeypatch.setattr(build, "cache_folder", lambda _: tmp_path)
    again = build_native_fmus(["drive_motor"])["drive_motor"]
    assert tmp_path in again.parents
    assert again.read_bytes() == native_fmus["drive_motor"].read_bytes()


def test_a_build_is_used_again(native_fmus, monkeypatch):
    monkeypatch.setattr(build, "object_code", lambda *_: pytest.fail("built again"))
    assert build_native_fmus(["drive_motor"]) == {"drive_motor": native_fmus["drive_motor"]}


def test_other_resources_make_another_fmu(tmp_path):
    model = registered_model("bench_controller")
    name, file = next(iter(model.resources.items()))
    other = tmp_path / name
    other.write_bytes(file.read_bytes() + b"# other\n")
    changed = type(model)(model.component, model.modules, {**model.resources, name: other})
    assert changed.key != model.key
    assert registered_model("bench_controller").key == model.key


def test_who_builds_what_another_one_is_building_waits_for_it(tmp_path, monkeypatch):
    monkeypatch.setattr(build, "cache_folder", lambda kind: tmp_path / kind)
    lock, asked, builders = fcntl.flock, [], []

    def ask(descriptor, operation):
        asked.append(descriptor)
        if len(asked) == 2:
            waits.set()
        lock(descriptor, operation)

    def built(*_):
        builders.append(threading.current_thread())
        if len(builders) == 1:
            other.start()
            assert waits.wait(10.0)
        return b"an FMU"

    waits = threading.Event()
    other = threading.Thread(target=build_native_fmus, args=(["shaft_coupling"],))
    monkeypatch.setattr(fcntl, "flock", ask)
    monkeypatch.setattr(build, "_built", built)
    file = build_native_fmus(["shaft_coupling"])["shaft_coupling"]
    other.join()
    assert file.read_bytes() == b"an FMU"
    assert builders == [threading.current_thread()]


def test_damaged_files_are_made_anew(tmp_path, monkeypatch, caplog):
    monkeypatch.setattr(build, "cache_folder", lambda kind: tmp_path / kind)
    good = build_native_fmus(["shaft_coupling"])["shaft_coupling"].read_bytes()
    for suffix in (".fmu", f".{OWN.extension}", ".o"):
        for file in tmp_path.rglob(f"*{suffix}"):
            file.write_bytes(file.read_bytes()[:100])
    assert build_native_fmus(["shaft_coupling"])["shaft_coupling"].read_bytes() == good
    assert "shaft_coupling.fmu is damaged; it is made anew" in caplog.text
    assert f"shaft_coupling.{OWN.extension} is damaged" in caplog.text
    assert f"{OWN.name}.o is damaged" in caplog.text


@pytest.mark.slow
@pytest.mark.skipif(not importlib.util.find_spec("ziglang"), reason="ziglang is not installed")
@pytest.mark.parametrize("fmi", build.VERSIONS)
def test_all_platforms_in_one_small_file(fmi, tmp_path, capsys):
    arguments = ["--native", "--platforms", "all", "--fmi", str(fmi), "-o", str(tmp_path)]
    assert main(["build", "gear_mesh", *arguments]) == 0
    said = capsys.readouterr().out.splitlines()
    file = tmp_path / {2: "gear_mesh.fmu", 3: "gear_mesh_fmi3.fmu"}[fmi]
    assert said[0] == str(file)
    assert said[1] == "built, not run: x86_64-darwin, aarch64-darwin"
    assert validation_problems(file) == []
    with zipfile.ZipFile(file) as archive:
        entries = archive.infolist()
        documentation = archive.read("documentation/index.html").decode()
    size = sum(e.compress_size for e in entries if not e.filename.startswith(ASIDE))
    assert size <= WITH_SINGLE_TEETH
    folders = {e.filename.split("/")[1] for e in entries if e.filename.startswith("binaries/")}
    assert folders == {p.name if fmi == 3 else p.folder for p in PLATFORMS.values()}
    assert "x86_64-darwin (built, not run)" in documentation
    assert "x86_64-linux (built" not in documentation


def test_both_fmi_versions_fit_into_one_folder(tmp_path):
    for fmi in build.VERSIONS:
        build_fmus(["shaft_coupling"], tmp_path, native=True, fmi=fmi)
    found = {file.name: read_model_description(file).fmiVersion for file in tmp_path.iterdir()}
    assert found == {"shaft_coupling.fmu": "2.0", "shaft_coupling_fmi3.fmu": "3.0"}


def test_resources_lie_in_the_file(native_fmus):
    for name, fmu in native_fmus.items():
        with zipfile.ZipFile(fmu) as archive:
            for file in (component_folder(name) / "resources").glob("*.csv"):
                assert archive.read(f"resources/{file.name}") == file.read_bytes()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--native", "--platforms", "amiga"], "platform 'amiga' is unknown; there are: x86_64-l"),
        (["--native", "--fmi", "1"], "FMI version 1; it must be 2 or 3"),
        (["--fmi", "3"], "--platforms and --fmi choose among native FMUs; add --native"),
        (["--set", "modal_housing.modes=x.csv"], "--set puts files into native FMUs; add --native"),
        (["--native", "--set", "modes"], "--set modes: it must be COMPONENT.PARAMETER=FILE"),
        (["gearbox", "--native"], "there is no component 'gearbox'"),
    ],
)
def test_bad_options_give_one_line(arguments, said, capsys):
    assert main(["build", *arguments]) == 2
    out, err = capsys.readouterr()
    assert (out, len(err.splitlines())) == ("", 1)
    assert said in err


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"fmi": 3}, r"platforms and fmi choose among native FMUs; add native=True"),
        ({"platforms": ["all"]}, r"platforms and fmi choose among native FMUs; add native=True"),
        ({"files": {"gear_mesh.x": "y"}}, r"files into native FMUs; add native=True"),
    ],
)
def test_what_python_fmus_have_not_is_refused_in_scripts(asked, said, tmp_path):
    with pytest.raises(ParameterError, match=said):
        build_fmus(["torque_source"], tmp_path, **asked)
    assert list(tmp_path.iterdir()) == []


def test_a_wrapper_that_was_not_stored_to_its_end_is_made_anew(tmp_path, monkeypatch):
    """As where the process died: some of its objects, each whole."""
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))
    whole = build._wrapper(own_platform(), 2)
    for file in whole[1:]:
        file.unlink()
    assert build._wrapper(own_platform(), 2) == whole
    assert all(file.is_file() for file in whole)


def test_without_compiler_native_is_refused_and_auto_takes_python(monkeypatch):
    monkeypatch.setattr(compiler.shutil, "which", lambda _: None)
    monkeypatch.setattr(compiler.importlib.util, "find_spec", lambda _: None)
    with pytest.raises(
        FmuError, match=r"no C compiler for .* with .pip install herringbone\[native\]"
    ):
        compiler.require_compiler(OWN)
    chosen, notes = kind.choose_kind("auto")
    assert chosen == "python"
    assert "Python FMUs instead of native ones" in notes[0]


def test_kinds_that_are_asked_for_are_taken():
    assert kind.choose_kind("in-process") == ("in-process", ())
    with pytest.raises(ParameterError, match="must be one of auto, native, python, in-process"):
        kind.choose_kind("wasm")


def test_failure_of_the_compiler_is_one_line(tmp_path):
    found = compiler.find_compiler(OWN) if OWN else None
    if found is None:
        pytest.skip("no C compiler for native FMUs was found")
    description = tmp_path / "part.c"
    description.write_text("#error this part is wrong\n")
    with pytest.raises(FmuError, match=r"failed: .*this part is wrong") as error:
        compiler.compile_library(
            found, OWN, description, [tmp_path / "none.o"], tmp_path / "part.so"
        )
    assert "\n" not in str(error.value)


def test_binaries_run_on_this_platform(native_fmus):
    assert fmpy.supported_platforms(str(native_fmus["gear_mesh"])) == [fmpy.platform]

"""Building, packing and checking FMUs."""

import zipfile

import pytest

from herringbone.components.registry import COMPONENTS
from herringbone.core import FmuError, StructureError
from herringbone.core.caching.keys import sources_key
from herringbone.core.places.paths import component_folder
from herringbone.fmi import build_python_fmus, check_fmu, without_unit
from herringbone.fmi.python import build
from herringbone.fmi.python.state import FmuState, from_bytes, to_bytes


def test_two_builds_are_identical(python_fmus, tmp_path):
    build._pack(list(COMPONENTS), tmp_path)
    for name, fmu in python_fmus.items():
        assert (tmp_path / f"{name}.fmu").read_bytes() == fmu.read_bytes()


def test_a_build_is_used_again(python_fmus, monkeypatch):
    monkeypatch.setattr(build, "_pack", lambda *_: pytest.fail("built again"))
    assert build_python_fmus(["drive_motor"]) == {"drive_motor": python_fmus["drive_motor"]}


@pytest.mark.parametrize("left", [0, 1000])
def test_a_damaged_fmu_is_built_again(left, monkeypatch, tmp_path, caplog):
    monkeypatch.setenv("HERRINGBONE_CACHE", str(tmp_path))
    fmu = build_python_fmus(["drive_motor"])["drive_motor"]
    whole = zipfile.ZipFile(fmu).namelist()
    assert "damaged" not in caplog.text
    fmu.write_bytes(fmu.read_bytes()[:left])
    assert build_python_fmus(["drive_motor"]) == {"drive_motor": fmu}
    assert "drive_motor.fmu is damaged; it is made anew" in caplog.text
    assert zipfile.ZipFile(fmu).namelist() == whole


def test_unknown_component():
    with pytest.raises(StructureError, match="there is no component 'gearbox'"):
        build_python_fmus(["gearbox"])


def test_failure_of_pythonfmu_names_component_and_cause(tmp_path):
    with pytest.raises(
        FmuError, match=r"pythonfmu could not build nothing: .*no component 'nothing'"
    ):
        build._pack(["nothing"], tmp_path)


@pytest.mark.parametrize("name", COMPONENTS)
def test_content_of_the_file(name, python_fmus):
    with zipfile.ZipFile(python_fmus[name]) as archive:
        names = archive.namelist()
        module = archive.read("resources/slavemodule.txt").decode()
        script = archive.read(f"resources/{module}.py").decode()
        assert {entry.date_time for entry in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        for file in (component_folder(name) / "resources").glob("*.csv"):
            assert archive.read(f"resources/{file.name}") == file.read_bytes()
    assert names == sorted(names)
    assert module == f"herringbone_{name}_{sources_key()}"
    assert script == (component_folder(name) / f"{name}.py").read_text()
    assert f"binaries/linux64/{name}.so" in names
    assert f"binaries/win64/{name}.dll" in names


@pytest.mark.parametrize("name", COMPONENTS)
def test_scripts_are_thin_and_have_two_methods(name):
    script = (component_folder(name) / f"{name}.py").read_text()
    assert script.count("    def ") >= 2
    assert script.count("import") == 1
    assert len(script.splitlines()) < 20


def test_check_reports_files_that_are_no_fmu(tmp_path):
    (tmp_path / "text.fmu").write_text("text")
    assert "is not an FMU" in check_fmu(tmp_path / "text.fmu")[0]
    with pytest.raises(FmuError, match=r"there is no file .*none\.fmu"):
        check_fmu(tmp_path / "none.fmu")


def test_check_reports_a_real_without_unit_and_an_invalid_structure(python_fmus, tmp_path):
    damaged = tmp_path / "damaged.fmu"
    with (
        zipfile.ZipFile(python_fmus["shaft_coupling"]) as source,
        zipfile.ZipFile(damaged, "w") as copy,
    ):
        for entry in source.namelist():
            data = source.read(entry)
            if entry == "modelDescription.xml":
                start, _, rest = data.partition(b"<InitialUnknowns>")
                _, _, end = rest.partition(b"</InitialUnknowns>")
                data = start.replace(b'unit="N.m"', b"") + end
            copy.writestr(entry, data)
    problems = check_fmu(damaged)
    assert "torque: a Real without unit" in without_unit(damaged)
    assert any("InitialUnknowns does not contain" in p for p in problems)


def test_time_needs_no_unit(fmi3_fmus, tmp_path):
    """FMI 3.0 declares it as a variable of its own."""
    bare = tmp_path / "bare.fmu"
    with zipfile.ZipFile(fmi3_fmus["shaft_coupling"]) as whole, zipfile.ZipFile(bare, "w") as copy:
        text = whole.read("modelDescription.xml").decode()
        time = next(line for line in text.splitlines() if 'causality="independent"' in line)
        for entry in set(whole.namelist()) - {"modelDescription.xml"}:
            copy.writestr(entry, whole.read(entry))
        copy.writestr("modelDescription.xml", text.replace(time, time.replace(' unit="s"', "")))
    assert ' unit="s"' in time
    assert without_unit(bare) == []


def test_serialised_state():
    state = FmuState("owner", b"\x00\n\xff", {"table": "ä.csv"}, "1f", 2, 0.1)
    assert from_bytes(to_bytes(state)) == state
    for wrong in (b"", b"{}", b"[1]\n", b"\xff\n", b'{"owner": "x"}\n'):
        assert from_bytes(wrong) is None
        assert from_bytes(b"0123\n" + wrong) is None


def test_a_flipped_bit_of_a_serialised_state_is_noticed():
    """Whichever it is: no state, or one without data."""
    whole = to_bytes(FmuState("owner", b"\x00\n\xff", {"table": "ä.csv"}, "1f", 2, 0.1))
    for bit in range(8 * len(whole)):
        damaged = bytearray(whole)
        damaged[bit // 8] ^= 1 << bit % 8
        state = from_bytes(bytes(damaged))
        assert state is None or state.data == b""

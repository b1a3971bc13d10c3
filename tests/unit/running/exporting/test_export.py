"""FMUs as files; exported systems are tested in interop."""

from zipfile import ZipFile

import pytest

import herringbone as hb
from herringbone.core import ParameterError, ResourceError, StructureError
from herringbone.cosim.structure.system_file import read_system
from herringbone.running.exporting.export import build_fmus, export_ssp


def test_fmus_are_built_and_copied(tmp_path):
    (built,) = build_fmus(["drive_motor"])
    (copied,) = build_fmus(["drive_motor"], tmp_path / "new" / "folder")
    assert copied == tmp_path / "new" / "folder" / "drive_motor.fmu"
    assert copied.read_bytes() == built.read_bytes()


def test_unknown_component_is_refused():
    with pytest.raises(StructureError, match="there is no component 'motor'"):
        build_fmus(["motor"])


def test_folder_that_cannot_be_written_is_refused(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(ResourceError, match="cannot write to"):
        build_fmus(["drive_motor"], tmp_path / "file")


def test_exported_file_must_be_an_ssp(tmp_path):
    with pytest.raises(ParameterError, match=r"must end in \.ssp"):
        export_ssp("gearbox", tmp_path / "gearbox.zip")


def test_a_system_itself_is_exported_under_its_name(tmp_path, monkeypatch, caplog):
    monkeypatch.chdir(tmp_path)
    file = hb.export(read_system("test_rig"), python=True, step=1e-4)
    assert file.name == "test_rig.ssp"
    assert [entry.name for entry in tmp_path.iterdir()] == ["test_rig.ssp"]
    assert "'herringbone run test_rig --algorithm" in caplog.text
    with ZipFile(file) as archive:
        assert "SystemStructure.ssd" in archive.namelist()

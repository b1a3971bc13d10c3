"""What is checked of an FMU file before anything of it is loaded."""

import os
import re
import sys
import tempfile
import zipfile

import fmpy
import pytest

from herringbone.core import FmuError
from herringbone.cosim.fmu.file import extract_fmu, read_fmu

BINARY = f"binaries/{fmpy.platform}/model{fmpy.sharedLibraryExtension}"
CO_SIMULATION = '<CoSimulation modelIdentifier="model"/>'
MODEL_EXCHANGE = '<ModelExchange modelIdentifier="model"/>'


def description(*, version="2.0", kinds=CO_SIMULATION, before=""):
    return (
        f'<?xml version="1.0" encoding="UTF-8"?>{before}'
        f'<fmiModelDescription fmiVersion="{version}" modelName="m" guid="{{0}}">{kinds}'
        '<ModelVariables><ScalarVariable name="y" valueReference="0" causality="output">'
        "<Real/></ScalarVariable></ModelVariables>"
        '<ModelStructure><Outputs><Unknown index="1"/></Outputs></ModelStructure>'
        "</fmiModelDescription>"
    )


def write(folder, text=None, names=(BINARY,)):
    file = folder / "x.fmu"
    with zipfile.ZipFile(file, "w") as archive:
        if text is not None:
            archive.writestr("modelDescription.xml", text)
        for name in names:
            archive.writestr(name, b"")
    return file


def refused(message, file):
    with pytest.raises(FmuError, match=re.escape(message)) as error:
        read_fmu(file)
    assert str(file) in str(error.value)
    return str(error.value)


def test_good_file(tmp_path):
    model = read_fmu(write(tmp_path, description()))
    assert model.coSimulation.modelIdentifier == "model"
    assert [v.name for v in model.modelVariables] == ["y"]


def test_both_kinds_are_good(tmp_path):
    assert read_fmu(write(tmp_path, description(kinds=MODEL_EXCHANGE + CO_SIMULATION)))


def test_missing_file(tmp_path):
    refused("there is no file", tmp_path / "none.fmu")


def test_folder(tmp_path):
    refused("is a folder; give an .fmu file", tmp_path)


@pytest.mark.skipif(sys.platform != "linux", reason="names are any bytes on Linux alone")
def test_names_that_are_not_utf8(tmp_path, monkeypatch):
    """Of the file, a folder on its way, or the current one: the FMU is not to blame."""
    good = write(tmp_path, description())
    folder = tmp_path / os.fsdecode(b"d\xff")
    folder.mkdir()
    said = r"the name 'd\udcff' is not UTF-8; rename it"
    with pytest.raises(FmuError, match=re.escape(said)):
        read_fmu(write(folder, description()))
    monkeypatch.chdir(folder)
    refused(r"the current folder, as its name 'd\udcff' is not UTF-8; rename it, or cd", good)


@pytest.mark.parametrize("content", [b"", b"not a zip", b"PK\x03\x04 cut"])
def test_no_zip(tmp_path, content):
    file = tmp_path / "x.fmu"
    file.write_bytes(content)
    refused("is not an FMU", file)


def test_damaged_description(tmp_path):
    file = write(tmp_path, description())
    data = bytearray(file.read_bytes())
    at = data.index(b"fmiModelDescription")
    data[at : at + 3] = b"XXX"  # its check sum is wrong now
    file.write_bytes(data)
    refused("modelDescription.xml cannot be read: Bad CRC-32", file)


def test_no_description(tmp_path):
    refused("is not an FMU: it contains no modelDescription.xml", write(tmp_path))


@pytest.mark.parametrize("version", ["1.0", "3.0-beta.1", "3.1", "30"])
def test_other_versions(tmp_path, version):
    said = refused(f"is an FMI {version} unit", write(tmp_path, description(version=version)))
    assert "FMI 2.0 or 3.0 for co-simulation is needed" in said


def test_unknown_version(tmp_path):
    refused("is an FMI unknown unit", write(tmp_path, "<fmiModelDescription/>"))


def test_model_exchange_only(tmp_path):
    refused("is for model exchange only", write(tmp_path, description(kinds=MODEL_EXCHANGE)))


@pytest.mark.parametrize(
    ("names", "have"),
    [
        (("binaries/amiga68k/model.so", "binaries/vax/model.so"), "amiga68k, vax"),
        ((), "none"),
        ((BINARY.replace("model", "other"),), fmpy.platform),
    ],
)
def test_no_binary_for_the_platform(tmp_path, names, have):
    said = refused("has no binary for this platform", write(tmp_path, description(), names))
    assert f"({BINARY}); it has: {have}" in said


@pytest.mark.parametrize(
    "name",
    ["../evil", "resources/../../evil", "/etc/evil", "..\\evil", "C:\\evil", "c:/evil", "\\evil"],
)
def test_entries_outside_the_folder(tmp_path, name):
    said = refused("would be written outside its folder; refused",
                   write(tmp_path, description(), (BINARY, name)))  # fmt: skip
    assert "evil" in said


def test_dots_in_names_are_no_climbing(tmp_path):
    assert read_fmu(write(tmp_path, description(), (BINARY, "resources/a..b", "resources/...")))


BOMB = '<!DOCTYPE x [<!ENTITY a "ha"><!ENTITY b "&a;&a;">]>'


@pytest.mark.parametrize("before", [BOMB, "<!DOCTYPE x>", '<!DOCTYPE x SYSTEM "file:///x">'])
def test_doctype_and_entities(tmp_path, before):
    refused("declares a DOCTYPE or an entity; refused", write(tmp_path, description(before=before)))


@pytest.mark.parametrize("before", ["<!doctype x>", '<!ENTITY a SYSTEM "file:///etc/passwd">'])
def test_what_is_no_xml(tmp_path, before):
    refused("is not well-formed", write(tmp_path, description(before=before)))


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16le", "utf-16be"])
def test_doctype_in_another_encoding(tmp_path, encoding):
    """Two bytes per character do not hide it."""
    text = description(before=BOMB).replace("UTF-8", encoding.upper())
    refused("declares a DOCTYPE or an entity; refused", write(tmp_path, text.encode(encoding)))


def test_description_in_another_encoding(tmp_path):
    """What both parsers read is the same text."""
    text = description().replace("UTF-8", "UTF-16").replace('modelName="m"', 'modelName="\u00fc"')
    assert read_fmu(write(tmp_path, text.encode("utf-16"))).modelName == "\u00fc"


def test_an_encoding_that_is_none(tmp_path):
    refused("is not well-formed", write(tmp_path, description().replace("UTF-8", "UTF-99")))


def test_xml_that_is_cut(tmp_path):
    said = refused("is not well-formed", write(tmp_path, description()[:-40]))
    assert "x.fmu" in said


@pytest.mark.parametrize("name", ["plain", "with space", "a_b.c-d~1"])
def test_extract(tmp_path, monkeypatch, name):
    temporary = tmp_path / name
    temporary.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    folder = extract_fmu(write(tmp_path, description()))
    assert folder.parent == temporary
    assert (folder / BINARY).is_file() and (folder / "modelDescription.xml").is_file()


def test_nothing_stays_of_an_interrupted_extraction(tmp_path, monkeypatch):
    def interrupted(archive, folder):
        (folder / "half").touch()
        raise KeyboardInterrupt

    temporary = tmp_path / "temporary"
    temporary.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    monkeypatch.setattr(zipfile.ZipFile, "extractall", interrupted)
    with pytest.raises(KeyboardInterrupt):
        extract_fmu(write(tmp_path, description()))
    assert not list(temporary.iterdir())


@pytest.mark.parametrize(
    "name",
    [
        "with ü",
        "with#",
        "with%20",
        "with(1)",
        "with+",
        "with@",
        "with,",
        "with=",
        "with[1]",
        "with&",
    ],
)
def test_extract_refuses_paths_that_python_fmus_cannot_load_from(tmp_path, monkeypatch, name):
    temporary = tmp_path / name
    temporary.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    of_python = write(tmp_path, description(), (BINARY, "resources/slavemodule.txt"))
    with pytest.raises(FmuError, match="set TMPDIR to a path of ASCII letters, digits,"):
        extract_fmu(of_python)
    assert not list(temporary.iterdir())
    assert (extract_fmu(write(tmp_path, description())) / BINARY).is_file()

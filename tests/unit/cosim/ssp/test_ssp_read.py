"""SSP 1.0 files that are read: whose values win, and what is refused by name."""

import tempfile
import zipfile
from shutil import copy

import pytest
from support.foreign.described_fmus import ELEMENT, SSD, make_fmu

from herringbone.core import FmuError, HerringboneError, StructureError
from herringbone.core.caching.remembered import Remembered
from herringbone.cosim.ssp import format as ssp_format
from herringbone.cosim.ssp.read import read_ssp
from herringbone.cosim.ssp.write import write_ssp

BINDING = (
    "<ssd:ParameterBindings><ssd:ParameterBinding><ssd:ParameterValues>"
    '<ssv:ParameterSet version="1.0" name="p"><ssv:Parameters>{}</ssv:Parameters>'
    "</ssv:ParameterSet></ssd:ParameterValues></ssd:ParameterBinding></ssd:ParameterBindings>"
)
REAL = '<ssv:Parameter name="{}"><ssv:Real value="{}"/></ssv:Parameter>'
REFUSED_STRUCTURES = {
    "version": ('version="1.0" name="chain"', 'version="2.0" name="chain"', "SSP version '2.0'"),
    "values of a nested system": (
        "<ssd:Elements>",
        '<ssd:Elements><ssd:System name="inner"><ssd:ParameterBindings/></ssd:System>',
        "nested system 'inner' has values; give them to its components",
    ),
    "signal dictionary reference": (
        "<ssd:Elements>",
        '<ssd:Elements><ssd:SignalDictionaryReference name="bus" dictionary="d"/>',
        "signal dictionary reference 'bus' is not supported",
    ),
    "signal dictionaries": (
        "</ssd:Connections>",
        "</ssd:Connections><ssd:SignalDictionaries/>",
        "signal dictionaries are not supported",
    ),
    "transformation": (
        'endConnector="f" />',
        'endConnector="f"><ssc:LinearTransformation factor="2"/></ssd:Connection>',
        "connection 'spring.force' - 'left.f': LinearTransformation is not supported",
    ),
    "no component": (
        'startElement="left" startConnector="port.s" endElement="spring" ',
        'startConnector="port.s" ',
        "connection 'system.port.s' - 'system.s': it needs connectors, and a component at one end",
    ),
    "other type": (
        'name="spring" type="application/x-fmu-sharedlibrary"',
        'name="spring" type="application/x-ssp-package"',
        "component 'spring' is of type application/x-ssp-package",
    ),
    "model exchange": (
        'name="spring" type',
        'name="spring" implementation="ModelExchange" type',
        "component 'spring' wants model exchange",
    ),
    "dotted name": ('Component name="right"', 'Component name="a.b"', "component name 'a.b'"),
    "outside": ("resources/element.fmu", "../element.fmu", "source '../element.fmu' lies outside"),
    "remote": ("resources/element.fmu", "http://x.org/e.fmu", "'http://x.org/e.fmu' lies outside"),
    "missing": ("resources/element.fmu", "resources/e.fmu", "there is no 'resources/e.fmu'"),
    "mapping": (
        'source="resources/left.ssv" />',
        'source="resources/left.ssv"><ssd:ParameterMapping source="m.ssm"/></ssd:ParameterBinding>',
        r"component 'left': parameter mappings \(.ssm\) are not supported",
    ),
    "prefix": (
        'source="resources/left.ssv"',
        'source="resources/left.ssv" prefix="a."',
        "component 'left': prefixes of parameter bindings",
    ),
    "values inside an FMU": (
        'source="resources/left.ssv"',
        'source="resources/left.ssv" sourceBase="component"',
        "component 'left': parameter sources inside an FMU",
    ),
    "other parameters": (
        "application/x-ssp-parameter-set",
        "text/csv",
        "component 'left': parameter source of type text/csv",
    ),
    "unknown instance": (
        "<ssd:Elements>",
        BINDING.format(REAL.format("middle.mass", "1")) + "<ssd:Elements>",
        "has no part 'middle'",
    ),
    "unit of a connector": (
        'unit="N"',
        'unit="kN"',
        "component 'left', connector 'f': unit 'kN' is not 'N' of the FMU's variable",
    ),
    "malformed": ("</ssd:Elements>", "", "is not well-formed"),
    "entity": (
        "<ssd:SystemStructureDescription",
        '<!DOCTYPE x [<!ENTITY e "x">]><ssd:SystemStructureDescription',
        "declares a DOCTYPE or an entity; refused",
    ),
}


def test_values_of_the_system_win_over_those_of_a_component(edited):
    binding = BINDING.format(REAL.format("left.mass", "2.5"))
    found = read_ssp(edited("<ssd:Elements>", f"{binding}<ssd:Elements>"))
    assert found.part("left").values["mass"] == 2.5
    assert found.part("left").values["count"] == 3


def test_geometry_and_foreign_annotations_are_passed_over(edited, system):
    folder = edited(
        'endConnector="f" />',
        'endConnector="f"><ssd:ConnectionGeometry pointsX="0" pointsY="0"/></ssd:Connection>',
    )
    assert read_ssp(folder).connections == system.connections


def test_connectors_that_are_no_port_are_open(edited, system):
    """One that leads to a single variable, and is told."""
    found = read_ssp(edited('startElement="left" ', ""))
    (note,) = found.notes
    assert note.endswith("connectors of no port are open: port.s")
    assert found.ports == {}
    assert set(found.connections) == set(system.connections) - {("left.port.s", "spring.s")}


@pytest.mark.parametrize("case", REFUSED_STRUCTURES)
def test_unknown_structures_are_refused_by_name(edited, case):
    old, new, message = REFUSED_STRUCTURES[case]
    with pytest.raises(StructureError, match=message):
        read_ssp(edited(old, new))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("<ssv:Integer", "<ssv:Complex", "parameter 'count': a value of type Complex"),
        ('<ssv:Integer value="3"', '<ssv:Integer value="3.5"', "'3.5' is no Integer"),
        ("<ssv:Real value", '<ssv:Real unit="g" value', "unit 'g' is not 'kg' of the variable"),
        ("<ssv:ParameterSet", '<!DOCTYPE x SYSTEM "y"><ssv:ParameterSet', "DOCTYPE"),
    ],
)
def test_unknown_values_are_refused_by_name(edited, old, new, message):
    with pytest.raises(StructureError, match=message):
        read_ssp(edited(old, new, "resources/left.ssv"))


def test_entity_in_another_encoding_is_refused(edited):
    folder = edited("UTF-8", "UTF-16")
    text = (folder / SSD).read_text(encoding="utf-8")
    text = text.replace("<ssd:System", '<!DOCTYPE x [<!ENTITY e "x">]><ssd:System', 1)
    (folder / SSD).write_text(text, encoding="utf-16")
    with pytest.raises(StructureError, match="DOCTYPE"):
        read_ssp(folder)


def test_component_of_another_fmi_version_is_refused_by_name(edited):
    folder = edited("UTF-8", "UTF-8")
    make_fmu(folder / "resources" / "element.fmu", ELEMENT, fmi_version="1.0")
    with pytest.raises(FmuError, match=r"component 'spring': .*element.fmu is an FMI 1.0 unit"):
        read_ssp(folder)


@pytest.mark.parametrize("name", ["../evil.txt", "/evil.txt", "a/../../evil.txt", "C:evil.txt"])
def test_entries_outside_the_folder_are_refused(tmp_path, name):
    file = tmp_path / "evil.ssp"
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr(name, "")
    with pytest.raises(StructureError, match="would be written outside its folder; refused"):
        read_ssp(file)


@pytest.fixture
def folders(tmp_path, monkeypatch):
    """Function that gives the folders of the .ssp files that this test unpacked."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(ssp_format, "_unpacked", Remembered(4))
    return lambda: list(tmp_path.glob("herringbone_run_*"))


def test_a_content_is_unpacked_once(ssp, system, fmus, tmp_path, folders):
    """A folder has a descriptor until the process ends; another content has another folder."""
    one, again, copied = (read_ssp(file) for file in (ssp, ssp, copy(ssp, tmp_path / "x.ssp")))
    assert one.parts == again.parts == copied.parts
    assert len(folders()) == 1
    write_ssp(system.with_values({"left.mass": 7.0}), fmus, ssp, step=1e-5, t_end=0.25)
    assert read_ssp(ssp).part("left").values["mass"] == 7.0
    assert len(folders()) == 2


def test_a_damaged_entry_leaves_no_folder(ssp, folders):
    content = ssp.read_bytes()
    assert content.count(b"port.s.node1") == 1
    ssp.write_bytes(content.replace(b"port.s.node1", b"port.s.node2"))
    with pytest.raises(StructureError, match="cannot be unpacked"):
        read_ssp(ssp)
    assert not folders()


@pytest.mark.parametrize(
    ("content", "message"), [(None, "there is no file"), (b"text", "is not an .ssp file")]
)
def test_what_is_no_file_is_refused(tmp_path, content, message):
    file = tmp_path / "x.ssp"
    if content:
        file.write_bytes(content)
    with pytest.raises(HerringboneError, match=message):
        read_ssp(file)


def test_file_without_structure_is_refused(tmp_path):
    file = tmp_path / "x.ssp"
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("a.txt", "")
    with pytest.raises(StructureError, match=r"contains no SystemStructure\.ssd"):
        read_ssp(file)

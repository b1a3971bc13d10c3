"""SSP 1.0 files: what is written is read again, what is not understood is refused by name."""

import zipfile
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import fmpy
import pytest
from fmpy.ssp import ssd as fmpy_ssp
from lxml import etree

from herringbone.core import FmuError, HerringboneError, ParameterError, StructureError
from herringbone.cosim.ssp.described import DescribedPart
from herringbone.cosim.ssp.read import read_ssp, read_stop_time
from herringbone.cosim.ssp.write import write_ssp
from herringbone.cosim.structure.system import PartSpec, System

SSD = "SystemStructure.ssd"
BODY = """
<ScalarVariable name="f" valueReference="0" causality="input" variability="continuous">
  <Real start="0.0" unit="N"/></ScalarVariable>
<ScalarVariable name="port.s" valueReference="1" causality="output" variability="continuous">
  <Real unit="m"/></ScalarVariable>
<ScalarVariable name="port.s.node1" valueReference="2" causality="output">
  <Real unit="m"/></ScalarVariable>
<ScalarVariable name="mass" valueReference="3" causality="parameter" variability="fixed">
  <Real start="1.0" unit="kg"/></ScalarVariable>
<ScalarVariable name="count" valueReference="4" causality="parameter" variability="fixed">
  <Integer start="1"/></ScalarVariable>
<ScalarVariable name="active" valueReference="5" causality="parameter" variability="fixed">
  <Boolean start="true"/></ScalarVariable>
<ScalarVariable name="table" valueReference="6" causality="parameter" variability="fixed">
  <String start="a.csv"/></ScalarVariable>
<ScalarVariable name="der(s)" valueReference="7" causality="local" initial="exact">
  <Real start="0.0" unit="m"/></ScalarVariable>
"""
ELEMENT = """
<ScalarVariable name="s" valueReference="0" causality="input"><Real start="0.0" unit="m"/>
</ScalarVariable>
<ScalarVariable name="force" valueReference="1" causality="output"><Real unit="N"/>
</ScalarVariable>
"""


def make_fmu(file, variables, fmi_version="2.0", newton='kg="1" m="1" s="-2"'):
    """An FMU of which only the description is ever read."""
    identifier = file.stem
    description = f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="{fmi_version}" modelName="{identifier}" guid="{identifier}">
<CoSimulation modelIdentifier="{identifier}"/>
<UnitDefinitions><Unit name="N"><BaseUnit {newton}/></Unit>
<Unit name="m"><BaseUnit m="1"/></Unit><Unit name="kg"><BaseUnit kg="1"/></Unit></UnitDefinitions>
<ModelVariables>{variables}</ModelVariables><ModelStructure/></fmiModelDescription>"""
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr(zipfile.ZipInfo("modelDescription.xml"), description)
        library = f"binaries/{fmpy.platform}/{identifier}{fmpy.sharedLibraryExtension}"
        archive.writestr(zipfile.ZipInfo(library), b"")
    return file


@pytest.fixture
def fmus(tmp_path):
    return {
        "body": make_fmu(tmp_path / "body.fmu", BODY),
        "element": make_fmu(tmp_path / "element.fmu", ELEMENT),
    }


@pytest.fixture
def system():
    values = {"mass": 1 / 3, "count": 3, "active": 0, "table": "ä & <b>.csv", "der(s)": -1e-300}
    return System(
        "chain",
        'two "bodies" & an element',
        (
            PartSpec("left", component="body", values=values),
            PartSpec("right", component="body"),
            PartSpec("spring", component="element"),
        ),
        (("left.port.s", "spring.s"), ("spring.force", "left.f")),
        channels={"force": ("spring.f*", "left.f"), "motion": ("*.s",)},
    )


@pytest.fixture
def ssp(system, fmus, tmp_path):
    file = tmp_path / "chain.ssp"
    write_ssp(system, fmus, file, step=1e-5, t_end=0.25)
    return file


@pytest.fixture
def edited(ssp, tmp_path):
    """The file unpacked, with one text replaced in one of its entries."""

    def edit(old, new, entry=SSD):
        folder = tmp_path / "unpacked"
        with zipfile.ZipFile(ssp) as archive:
            archive.extractall(folder)
        text = (folder / entry).read_text(encoding="utf-8")
        assert old in text
        (folder / entry).write_text(text.replace(old, new), encoding="utf-8")
        return folder

    return edit


def test_written_system_is_read_again(ssp, system):
    found = read_ssp(ssp)
    assert (found.name, found.description) == (system.name, system.description)
    assert found.connections == system.connections
    assert found.channels == system.channels
    assert [part.name for part in found.parts] == ["left", "right", "spring"]
    assert [part.values for part in found.parts] == [part.values for part in system.parts]
    assert [type(v) for v in found.parts[0].values.values()] == [float, int, int, str, float]
    assert read_stop_time(ssp) == 0.25


def test_fmus_are_packed_once_and_unchanged(ssp, fmus):
    left, right, spring = (part.fmu for part in read_ssp(ssp).parts)
    assert left == right
    assert left.read_bytes() == fmus["body"].read_bytes()
    assert spring.read_bytes() == fmus["element"].read_bytes()


def test_foreign_files_with_the_same_name_are_kept_apart(system, fmus, ssp, tmp_path):
    (tmp_path / "other").mkdir()
    other = make_fmu(tmp_path / "other" / "body.fmu", BODY.replace('start="1.0"', 'start="2.0"'))
    write_ssp(system.with_fmu("right", other), fmus, ssp, step=1e-5, t_end=0.25)
    left, right, _ = (part.fmu for part in read_ssp(ssp).parts)
    assert left.read_bytes() == fmus["body"].read_bytes()
    assert right.read_bytes() == other.read_bytes()


def test_same_system_gives_same_bytes(ssp, system, fmus, tmp_path):
    again = tmp_path / "again.ssp"
    write_ssp(system, fmus, again, step=1e-5, t_end=0.25)
    assert again.read_bytes() == ssp.read_bytes()


def test_file_follows_the_schemas_of_ssp_1_0(ssp):
    folder = Path(fmpy_ssp.__file__).parent / "schema"
    with zipfile.ZipFile(ssp) as archive:
        for entry, schema in ((SSD, "Description"), ("resources/left.ssv", "ParameterValues")):
            document = etree.fromstring(archive.read(entry))
            rules = etree.XMLSchema(etree.parse(folder / f"SystemStructure{schema}.xsd"))
            rules.assertValid(document)


def test_other_masters_find_what_they_need(ssp):
    with zipfile.ZipFile(ssp) as archive:
        text = archive.read(SSD).decode()
    start, _, rest = text.partition("<ssd:System ")
    assert start.count("xmlns:") == 6
    assert "xmlns" not in rest
    assert '<osp:FixedStepAlgorithm baseStepSize="1e-05" />' in rest
    assert '<oms:FixedStepMaster description="oms-ma" stepSize="1e-05"' in rest
    assert '<ssc:Unit name="N">\n      <ssc:BaseUnit kg="1" m="1" s="-2" />' in rest
    assert ".node" not in rest


def test_unconnected_outputs_are_connectors_and_inputs_are_not(ssp):
    with zipfile.ZipFile(ssp) as archive:
        root = etree.fromstring(archive.read(SSD))
    right = root.xpath("//*[local-name()='Component'][@name='right']")[0]
    assert right.xpath(".//*[local-name()='Connector']/@name") == ["port.s"]


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"left.weight": 1.0}, "left: body.fmu has no variable 'weight'"),
        ({"left.table": 1.0}, "left.table = 1.0: this String has no place"),
        ({"left.mass": "heavy"}, "left.mass = 'heavy': this Real has no place"),
    ],
)
def test_wrong_values_are_refused_in_writing(system, fmus, tmp_path, values, message):
    with pytest.raises(ParameterError, match=message):
        write_ssp(system.with_values(values), fmus, tmp_path / "x.ssp", step=1e-5, t_end=1.0)


def test_value_of_an_fmu_3_is_refused_with_the_remedy(fmi3_fmus):
    part = DescribedPart("load", fmi3_fmus["load_motor"], {"inertia": 0.1})
    said = r"load\.inertia = 0\.1: SSP 1\.0 has no value of type Float64, .* replace this part by"
    with pytest.raises(ParameterError, match=said):
        list(part.typed_values())


BINDING = (
    "<ssd:ParameterBindings><ssd:ParameterBinding><ssd:ParameterValues>"
    '<ssv:ParameterSet version="1.0" name="p"><ssv:Parameters>{}</ssv:Parameters>'
    "</ssv:ParameterSet></ssd:ParameterValues></ssd:ParameterBinding></ssd:ParameterBindings>"
)
REAL = '<ssv:Parameter name="{}"><ssv:Real value="{}"/></ssv:Parameter>'


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
    "malformed": ("</ssd:Elements>", "", "is not well-formed"),
    "entity": (
        "<ssd:SystemStructureDescription",
        '<!DOCTYPE x [<!ENTITY e "x">]><ssd:SystemStructureDescription',
        "declares a DOCTYPE or an entity; refused",
    ),
}


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


def test_units_with_two_meanings_are_refused(fmus, tmp_path):
    fmus["other"] = make_fmu(tmp_path / "other.fmu", ELEMENT, newton='kg="1" m="2" s="-2"')
    system = System("two", "", (PartSpec("first", "element"), PartSpec("second", "other")), ())
    with pytest.raises(StructureError, match=r"second\.force: unit 'N' is defined otherwise"):
        write_ssp(system, fmus, tmp_path / "x.ssp", step=1e-5, t_end=1.0)


def nested(system):
    """The system in another one, with a part beside it that acts on it from outside."""
    inner = system.nested_as("box")
    return replace(
        inner,
        parts=(
            *inner.parts,
            PartSpec("far.away", component="element"),
            PartSpec("z", component="body"),
        ),
        connections=(
            *inner.connections,
            ("box.right.port.s", "far.away.s"),
            ("far.away.force", "box.right.f"),
        ),
        ports={"left": "box.left.port"},
    )


def corners(element):
    return [float(element.get(key)) for key in ("x1", "y1", "x2", "y2")]


def test_nested_systems_stay_so_and_are_wired_alike(system, fmus, tmp_path):
    """Followed through the borders, connections are those of the flat file; nothing overlaps."""
    whole, file = nested(system), tmp_path / "nested.ssp"
    write_ssp(whole, fmus, file, step=1e-5, t_end=0.25, nested=True)
    schema = Path(fmpy_ssp.__file__).parent / "schema" / "SystemStructureDescription.xsd"
    with zipfile.ZipFile(file) as archive:
        root = etree.fromstring(archive.read(SSD))
    etree.XMLSchema(etree.parse(schema)).assertValid(root)
    top = root.find("{*}System")
    assert [e.get("name") for e in top.find("{*}Elements")] == ["z", "box", "far"]
    names = {c.get("name"): c.get("kind") for c in top.find("{*}Connectors")}
    assert names == {"left.s": "output"}
    came = {}
    for box in root.iter("{*}System"):
        path = "" if box is top else f"{box.get('name')}."
        for c in box.iterfind("{*}Connections/{*}Connection"):
            start, end = (
                f"{path}{c.get(f'{side}Element')}" if c.get(f"{side}Element") else path[:-1]
                for side in ("start", "end")
            )
            came[end, c.get("endConnector")] = start, c.get("startConnector")
        places = [corners(e.find("{*}ElementGeometry")) for e in box.find("{*}Elements")]
        assert box.find("{*}SystemGeometry") is None  # OMSimulator 3.0 refuses the file for it
        assert all(0.0 < a < c and 0.0 < b < d for a, b, c, d in places)
        for one, other in combinations(places, 2):
            assert (
                one[0] >= other[2] or other[0] >= one[2] or one[1] >= other[3] or other[1] >= one[3]
            )

    def source(end):
        start = came[end]
        return source(start) if start in came else start

    for start, end in whole.connections:
        (part, output), (target, into) = whole.split(start), whole.split(end)
        assert source((target, into)) == (part, output)


def test_nested_systems_are_read_again(system, fmus, tmp_path):
    """Paths, values and connections; a connector that nothing arrives at is refused."""
    whole, file = nested(system), tmp_path / "nested.ssp"
    write_ssp(whole, fmus, file, step=1e-5, t_end=0.25, nested=True)
    found = read_ssp(file)
    assert found.ports == whole.ports
    assert not found.notes
    assert sorted(found.paths) == sorted(whole.paths)
    assert set(found.connections) == set(whole.connections)
    for part in whole.parts:
        assert found.part(part.name).values == part.values
    folder = tmp_path / "unpacked"
    with zipfile.ZipFile(file) as archive:
        archive.extractall(folder)
    text = (folder / SSD).read_text(encoding="utf-8")
    cut = text.replace('endConnector="right__f"', 'endConnector="other"')
    assert cut != text
    (folder / SSD).write_text(cut, encoding="utf-8")
    with pytest.raises(StructureError, match=r"'box__right.f': no output of a component arrives"):
        read_ssp(folder)

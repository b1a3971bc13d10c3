"""Systems in systems in SSP files: written, wired alike, read again."""

import zipfile
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import pytest
from fmpy.ssp import ssd as fmpy_ssp
from lxml import etree
from support.foreign.described_fmus import SSD

from herringbone.core import StructureError
from herringbone.cosim.ssp.read import read_ssp
from herringbone.cosim.ssp.write import write_ssp
from herringbone.cosim.structure.system import PartSpec


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
    """Paths, values and connections."""
    whole, file = nested(system), tmp_path / "nested.ssp"
    write_ssp(whole, fmus, file, step=1e-5, t_end=0.25, nested=True)
    found = read_ssp(file)
    assert found.ports == whole.ports
    assert not found.notes
    assert sorted(found.paths) == sorted(whole.paths)
    assert set(found.connections) == set(whole.connections)
    for part in whole.parts:
        assert found.part(part.name).values == part.values


OUT_OF_BOX = (
    '<ssd:Connection startElement="right" startConnector="port.s" endConnector="right__port.s" />'
)
INTO_BOX = 'endElement="box" endConnector="right__f" />'
FROM_FAR = '<ssd:Connection startElement="far" startConnector="away__force" '
FROM_Z = '<ssd:Connection startElement="z" startConnector="port.s" '
TOP = "<ssd:Elements>\n      <ssd:Component"
VALUE = (
    "<ssd:ParameterBindings><ssd:ParameterBinding><ssd:ParameterValues>"
    '<ssv:ParameterSet version="1.0" name="p"><ssv:Parameters><ssv:Parameter '
    'name="a box.right.mass"><ssv:Real value="2.5"/></ssv:Parameter></ssv:Parameters>'
    "</ssv:ParameterSet></ssd:ParameterValues></ssd:ParameterBinding></ssd:ParameterBindings>"
)
REFUSED = {
    "no such connector": (
        'endConnector="right__f"',
        'endConnector="other"',
        "nested system 'box' has no connector 'other'",
    ),
    "no source": (
        OUT_OF_BOX,
        "",
        r"connection 'far__away\.s': no output of a component arrives there",
    ),
    "no such start inside": (
        'startElement="right" startConnector="port.s"',
        'startElement="zz" startConnector="y"',
        "connection 'box__zz.y': there is no component 'box__zz'",
    ),
    "no such end": (
        INTO_BOX,
        f'{INTO_BOX}{FROM_Z}endElement="bb" endConnector="f" />',
        r"connection 'bb\.f': there is no component 'bb'",
    ),
    "two sources": (
        INTO_BOX,
        f"{INTO_BOX}{FROM_Z}{INTO_BOX}",
        r"connector 'box\.right__f' has two sources: 'far\.\S+' and 'z\.port\.s'",
    ),
    "outer half without conversion": (
        INTO_BOX,
        INTO_BOX.replace("/>", 'suppressUnitConversion="true" />'),
        r"- 'box__right\.f': suppressUnitConversion is not supported",
    ),
}


@pytest.fixture
def changed(system, fmus, tmp_path):
    """The nested file unpacked, with texts replaced."""

    def change(*texts):
        file, folder = tmp_path / "nested.ssp", tmp_path / "unpacked"
        write_ssp(nested(system), fmus, file, step=1e-5, t_end=0.25, nested=True)
        with zipfile.ZipFile(file) as archive:
            archive.extractall(folder)
        text = (folder / SSD).read_text(encoding="utf-8")
        for old, new in texts:
            assert old in text
            text = text.replace(old, new)
        (folder / SSD).write_text(text, encoding="utf-8")
        return folder

    return change


@pytest.mark.parametrize("case", REFUSED)
def test_connections_that_would_be_lost_are_refused(changed, case):
    """Each would leave a connection out, or one of its properties, without a word."""
    old, new, message = REFUSED[case]
    with pytest.raises(StructureError, match=message):
        read_ssp(changed((old, new)))


def test_an_open_input_of_a_nested_system_keeps_its_start_value(changed, system):
    """As one of a component does; a note says so."""
    found = read_ssp(changed((f"{FROM_FAR}{INTO_BOX}", "")))
    (note,) = found.notes
    assert "nothing arrives at box.right__f: what these inputs of nested systems lead to" in note
    whole = set(nested(system).connections)
    assert set(found.connections) == whole - {("far.away.force", "box.right.f")}


def test_a_value_of_the_whole_for_a_part_in_a_system_of_any_name(changed):
    """`a box` is no identifier, and no component."""
    texts = ('name="box"', 'name="a box"'), ('Element="box"', 'Element="a box"'), (TOP, VALUE + TOP)
    found = read_ssp(changed(*texts))
    assert found.part("a_box__right").values["mass"] == 2.5

"""SSP 1.0 files that are written: read again, packed once, as the schemas ask."""

import zipfile
from pathlib import Path

import pytest
from fmpy.ssp import ssd as fmpy_ssp
from lxml import etree
from support.foreign.described_fmus import BODY, SSD, make_fmu

from herringbone.core import ParameterError
from herringbone.cosim.ssp.described import DescribedPart
from herringbone.cosim.ssp.read import read_ssp, read_stop_time
from herringbone.cosim.ssp.write import write_ssp

SIZED = """
<UInt64 name="n" valueReference="0" causality="structuralParameter" variability="fixed" start="2"/>
<Float64 name="u" valueReference="1" causality="input" start="0 0"><Dimension valueReference="0"/>
</Float64>
"""


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


@pytest.mark.parametrize("name", ["my#body.fmu", "body 100%25.fmu", "which?.fmu", "kör per.fmu"])
def test_fmu_files_of_any_name_are_found_again(system, fmus, tmp_path, name):
    """In the file they have plain names, which are the same in a URI."""
    other, file = make_fmu(tmp_path / name, BODY), tmp_path / "x.ssp"
    write_ssp(system.with_fmu("right", other), fmus, file, step=1e-5, t_end=0.25)
    found = read_ssp(file).part("right").fmu
    assert found.name == "right.fmu"
    assert found.read_bytes() == other.read_bytes()


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
        ({"left.table": 1.0}, "left.table = 1.0: it takes a String"),
        ({"left.mass": "heavy"}, "left.mass = 'heavy': it takes a Real, a number"),
        ({"left.count": 2.7}, "left.count = 2.7: its type is Integer, it takes a whole number"),
        ({"left.active": "no"}, "left.active = 'no': it takes a Boolean, true or false"),
    ],
)
def test_wrong_values_are_refused_in_writing(system, fmus, tmp_path, values, message):
    with pytest.raises(ParameterError, match=message):
        write_ssp(system.with_values(values), fmus, tmp_path / "x.ssp", step=1e-5, t_end=1.0)


@pytest.mark.parametrize(
    ("given", "written"), [("false", 0), ("true", 1), (True, 1), (0.0, 0), (1, 1)]
)
def test_booleans_are_taken_as_in_a_run(system, fmus, tmp_path, given, written):
    """Also as words, which were refused."""
    file = tmp_path / "x.ssp"
    write_ssp(system.with_values({"left.active": given}), fmus, file, step=1e-5, t_end=1.0)
    assert read_ssp(file).part("left").values["active"] == written


def test_value_of_an_fmu_3_is_refused_with_the_remedy(fmi3_fmus):
    part = DescribedPart("load", fmi3_fmus["load_motor"], {"inertia": 0.1})
    said = r"load\.inertia = 0\.1: SSP 1\.0 has no value of type Float64, .* replace this part by"
    with pytest.raises(ParameterError, match=said):
        list(part.typed_values())


def test_arrays_have_the_size_that_is_set(tmp_path):
    """What refuses the part is its FMI version, and not an element that is there."""
    file = make_fmu(tmp_path / "sized.fmu", SIZED, fmi_version="3.0")
    assert list(DescribedPart("p", file, {}).variables) == ["n", "u[1]", "u[2]"]
    part = DescribedPart("p", file, {"n": 3})
    assert list(part.variables) == ["n", "u[1]", "u[2]", "u[3]"]
    with pytest.raises(ParameterError, match=r"p\.n = 3: SSP 1\.0 has no value of type UInt64"):
        list(part.typed_values())
    with pytest.raises(ParameterError, match=r"p\.n = 'many'"):
        list(DescribedPart("p", file, {"n": "many"}).variables)

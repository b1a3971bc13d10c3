"""Units in SSP 1.0 files: what connectors declare agrees with the FMUs, or is refused."""

import zipfile

import pytest
from support.foreign.described_fmus import ELEMENT, SSD, make_fmu

from herringbone.core import StructureError
from herringbone.cosim.ssp.read import read_ssp
from herringbone.cosim.ssp.write import write_ssp
from herringbone.cosim.structure.system import PartSpec, System

TWO_WAYS = ELEMENT.replace(' unit="N"', "").replace("force", "y").replace(' unit="m"', "")
TEMPERATURE = """
<ScalarVariable name="T" valueReference="0" causality="output"><Real unit="degC"/></ScalarVariable>
"""
RISE = """
<ScalarVariable name="dT" valueReference="1" causality="output">
<Real unit="degC" relativeQuantity="true"/></ScalarVariable>
"""
UNITS = (
    '<ssd:Units><ssc:Unit name="rpm"><ssc:BaseUnit rad="1" s="-1" factor="0.1047"/></ssc:Unit>'
    '<ssc:Unit name="r/min"><ssc:BaseUnit rad="1" s="-1" factor="0.1047" m="0"/></ssc:Unit>'
    '<ssc:Unit name="rad/s"><ssc:BaseUnit rad="1" s="-1"/></ssc:Unit></ssd:Units>'
)
VALUE = (
    "<ssd:ParameterBindings><ssd:ParameterBinding><ssd:ParameterValues>"
    '<ssv:ParameterSet version="1.0" name="p"><ssv:Parameters><ssv:Parameter name="{}">'
    '<ssv:Real value="7" unit="{}"/></ssv:Parameter></ssv:Parameters>{}</ssv:ParameterSet>'
    "</ssd:ParameterValues></ssd:ParameterBinding></ssd:ParameterBindings>"
)
NESTED = (
    '<ssd:System name="N"><ssd:Connectors><ssd:Connector name="i" kind="input">'
    '<ssc:Real unit="{}"/></ssd:Connector></ssd:Connectors><ssd:Elements>'
)
NESTED_END = (
    '</ssd:Elements><ssd:Connections><ssd:Connection startConnector="i" endElement="b" '
    'endConnector="s"/></ssd:Connections></ssd:System>'
)
INTO = 'endElement="N" endConnector="i" />'


@pytest.fixture
def with_units(tmp_path):
    """A file of two FMUs without units, whose connectors declare some."""

    def write(output, input_):
        fmu = make_fmu(tmp_path / "plain.fmu", TWO_WAYS)
        parts = tuple(PartSpec(name, component="plain") for name in "ab")
        file = tmp_path / "plain.ssp"
        system = System("plain", "", parts, (("a.y", "b.s"),))
        write_ssp(system, {"plain": fmu}, file, step=1e-3, t_end=1.0)
        folder = tmp_path / "plain"
        with zipfile.ZipFile(file) as archive:
            archive.extractall(folder)
        text = (folder / SSD).read_text(encoding="utf-8")
        for kind, unit in (("output", output), ("input", input_)):
            old = f'kind="{kind}">\n            <ssc:Real />'
            assert old in text
            text = text.replace(old, old.replace(" />", f' unit="{unit}" />'))
        text = text.replace("<ssd:DefaultExperiment", f"{UNITS}<ssd:DefaultExperiment")
        (folder / SSD).write_text(text, encoding="utf-8")
        return folder

    return write


def test_units_of_connectors_that_differ_are_refused(with_units):
    """FMUs without units: another master would convert, this one has nothing to convert by."""
    said = r"connection 'a\.y' - 'b\.s': unit 'rpm' is not 'rad/s', and not both"
    with pytest.raises(StructureError, match=said):
        read_ssp(with_units("rpm", "rad/s"))


@pytest.mark.parametrize("units", [("rpm", "rpm"), ("rpm", "r/min"), ("rpm", "")])
def test_equal_units_of_connectors_are_taken(with_units, units):
    """By name or by definition; an end without any is not known."""
    assert read_ssp(with_units(*units)).connections == (("a.y", "b.s"),)


@pytest.mark.parametrize(
    ("units", "said"),
    [
        (("rpm", "rad/s", "rpm"), None),
        (("rpm", "", "rpm"), None),
        (("", "rpm", "rpm"), None),
        (("rpm", "rad/s", ""), "unit 'rpm' is not 'rad/s', and not both FMUs"),
        (("", "rad/s", "rpm"), "unit 'rad/s' is not 'rpm', and not both FMUs"),
    ],
)
def test_units_of_connectors_between(with_units, units, said):
    """A nested system around the end of the wire: its connector stands for an end without unit.

    Between ends of one unit it does not matter: there and back.
    """
    output, between, into = units
    folder = with_units(output, into)
    file = folder / SSD
    text = file.read_text(encoding="utf-8")
    place = text.index('<ssd:Component name="b"')
    end = text.index("</ssd:Component>", place) + len("</ssd:Component>")
    inner = f"{NESTED.format(between)}{text[place:end]}{NESTED_END}"
    text = f"{text[:place]}{inner}{text[end:]}"
    file.write_text(text.replace('endElement="b" endConnector="s" />', INTO), encoding="utf-8")
    if said is None:
        assert read_ssp(folder).connections == (("a.y", "N.b.s"),)
        return
    with pytest.raises(StructureError, match=said):
        read_ssp(folder)


def with_value(folder, component, name, unit, units=""):
    """The folder, with a value 7 of a component in a unit."""
    file = folder / SSD
    text, given = file.read_text(encoding="utf-8"), VALUE.format(name, unit, units)
    place = text.index("</ssd:Component>", text.index(f'name="{component}"'))
    file.write_text(f"{text[:place]}{given}{text[place:]}", encoding="utf-8")
    return folder


@pytest.mark.parametrize(
    ("connector", "unit", "said"),
    [
        ("rpm", "rad/s", r"component 'b', parameter 's': unit 'rad/s' is not 'rpm' of the conn"),
        ("rpm", "r/min", r"unit 'r/min' is not 'rpm' of the connector; convert it"),
    ],
)
def test_a_value_in_another_unit_than_its_connector(with_units, connector, unit, said):
    """The FMU declares none; 7 rad/s had arrived as 7 rpm. A name alone does not say `rpm`."""
    with pytest.raises(StructureError, match=said):
        read_ssp(with_value(with_units("", connector), "b", "s", unit))


def test_a_value_in_the_unit_of_its_connector(with_units):
    """By name, or by the definition of the parameter set."""
    defined = UNITS.replace("ssd:Units", "ssv:Units")
    for unit, units in (("rpm", ""), ("r/min", defined)):
        found = read_ssp(with_value(with_units("", "rpm"), "b", "s", unit, units))
        assert found.part("b").values["s"] == 7.0
        assert not found.notes


def test_a_value_in_a_unit_that_nothing_declares(with_units):
    """It is taken as it stands, which a note says; `1` is no unit."""
    (note,) = read_ssp(with_value(with_units("", ""), "b", "s", "mm")).notes
    assert note.endswith(
        "neither FMU nor connector declares a unit for b.s [mm]: the values are taken as they stand"
    )
    assert not read_ssp(with_value(with_units("", ""), "b", "s", "1")).notes


@pytest.mark.parametrize(
    ("base", "same"),
    [('m="1"', True), ('m="1" factor="1.0001"', True), ('m="1" factor="2"', False)],
)
def test_a_unit_that_a_parameter_set_defines_otherwise(edited, base, same):
    """One name with a factor of 2 is another unit; the factor may be rounded, to 1e-3."""
    units = f'<ssv:Units><ssc:Unit name="m"><ssc:BaseUnit {base}/></ssc:Unit></ssv:Units>'
    folder = with_value(edited("UTF-8", "UTF-8"), "spring", "s", "m", units)
    if same:
        assert read_ssp(folder).part("spring").values["s"] == 7.0
        return
    with pytest.raises(StructureError, match="unit 'm' is defined otherwise than 'm' of the var"):
        read_ssp(folder)


def test_a_connector_whose_unit_is_defined_otherwise(edited):
    """kN under the name that the FMU has for N: another master would convert."""
    folder = edited('kg="1" m="1" s="-2"', 'kg="1" m="1" s="-2" factor="1000"')
    with pytest.raises(StructureError, match="connector 'f': unit 'N' is defined otherwise than"):
        read_ssp(folder)


def test_definition_of_a_unit_is_of_numbers(edited):
    with pytest.raises(StructureError, match="unit 'N': 'one' is not a whole number"):
        read_ssp(edited('kg="1" m="1"', 'kg="one" m="1"'))


def test_unit_of_a_connector_under_another_name(edited):
    """`newton` is defined as the FMU defines `N`."""
    folder = edited('name="N"', 'name="newton"')
    text = (folder / SSD).read_text(encoding="utf-8")
    (folder / SSD).write_text(text.replace('unit="N"', 'unit="newton"'), encoding="utf-8")
    assert ("spring.force", "left.f") in read_ssp(folder).connections


def test_units_with_two_meanings_are_refused(fmus, tmp_path):
    fmus["other"] = make_fmu(tmp_path / "other.fmu", ELEMENT, newton='kg="1" m="2" s="-2"')
    system = System("two", "", (PartSpec("first", "element"), PartSpec("second", "other")), ())
    with pytest.raises(StructureError, match=r"second\.force: unit 'N' is defined otherwise"):
        write_ssp(system, fmus, tmp_path / "x.ssp", step=1e-5, t_end=1.0)


@pytest.mark.parametrize("more", [RISE, RISE + TEMPERATURE, TEMPERATURE + RISE])
def test_a_difference_has_no_other_unit(tmp_path, more):
    """A unit's offset is that of the absolute variables, wherever they stand."""
    fmus = {"heat": make_fmu(tmp_path / "heat.fmu", more)}
    system = System("one", "", (PartSpec("heat", "heat"),), ())
    write_ssp(system, fmus, tmp_path / "x.ssp", step=1e-5, t_end=1.0)
    with zipfile.ZipFile(tmp_path / "x.ssp") as archive:
        text = archive.read(SSD).decode()
    assert ('<ssc:BaseUnit K="1" offset="273.15" />' in text) == (TEMPERATURE in more)
    assert text.count('K="1"') == 1

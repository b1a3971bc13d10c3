"""Variables of an FMU 3.0 as the master sees them."""

import zipfile
from types import SimpleNamespace

import fmpy
import pytest

from herringbone.core import FmuError
from herringbone.cosim.fmu.file import read_fmu
from herringbone.cosim.fmu.variables import element_name, read_elements, read_variables

KINDS = (
    "Float32", "Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64", "Boolean",
)  # fmt: skip


def write(folder, kind="CoSimulation", more=""):
    others = "".join(
        f'<{k} name="{k}" valueReference="{20 + i}" causality="output"/>'
        for i, k in enumerate(KINDS)
    )
    text = f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="m" instantiationToken="t">
<{kind} modelIdentifier="model"/>
<UnitDefinitions><Unit name="mm"><BaseUnit m="1" factor="0.001"/></Unit>
<Unit name="degC"><BaseUnit K="1" offset="273.15"/></Unit></UnitDefinitions>
<TypeDefinitions><Float64Type name="Rise" unit="degC" relativeQuantity="true"/></TypeDefinitions>
<ModelVariables>
<Float64 name="u" valueReference="3" causality="input" start="2" unit="mm"/>
<Float64 name="u.node" valueReference="4" causality="input" start="2" unit="mm">
<Dimension start="4"/></Float64>
<Float64 name="table" valueReference="8" causality="output"><Dimension start="2"/>
<Dimension start="3"/></Float64>
<Float64 name="y" valueReference="9" causality="output"/>
{others}{more}
<String name="file" valueReference="40" causality="parameter" variability="fixed">
<Start value="x"/></String>
</ModelVariables>
<ModelStructure><Output valueReference="9" dependencies="3 4"/></ModelStructure>
</fmiModelDescription>"""
    file = folder / "x.fmu"
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("modelDescription.xml", text)
        archive.writestr(f"binaries/{fmpy.platform_tuple}/model{fmpy.sharedLibraryExtension}", b"")
    return file


def test_references_are_numbers_of_elements(tmp_path):
    model = read_fmu(write(tmp_path))
    variables = read_variables(model)
    numbers = {name: v.reference for name, v in variables.items() if v.is_real}
    table = [f"table[{i},{k}]" for i in (1, 2) for k in (1, 2, 3)]
    names = ["u", "u.node1", "u.node2", "u.node3", "u.node4", *table, "y"]
    assert numbers == {name: number for number, name in enumerate(names)}
    layout = [(e.variable.valueReference, e.first, e.size, e.place) for e in read_elements(model)]
    nodes, elements = [(4, 1, 4, k) for k in range(4)], [(8, 5, 6, k) for k in range(6)]
    assert layout == [(3, 0, 1, 0), *nodes, *elements, (9, 11, 1, 0)]


def test_what_is_declared(tmp_path):
    variables = read_variables(read_fmu(write(tmp_path)))
    assert variables["u"].causality == "input"
    assert variables["u.node2"].dimension == (0.001, 0.0, (("m", 1),))
    assert variables["y"].dependencies == {"u", "u.node"}
    assert (variables["table[2,3]"].type, variables["table[2,3]"].array) == ("Float64", "table")
    assert (variables["u.node2"].array, variables["y"].array) == ("u.node", "")
    assert variables["file"].type == "String"
    assert [variables[kind].type for kind in KINDS] == list(KINDS)


def test_the_unit_of_a_difference_has_no_offset(tmp_path):
    """By the variable, or by its type unless the variable says otherwise."""
    told = {
        "T": 'unit="degC"',
        "dT": 'unit="degC" relativeQuantity="true"',
        "rise": 'declaredType="Rise"',
        "T_of_type": 'declaredType="Rise" relativeQuantity="false"',
    }
    more = "".join(
        f'<Float64 name="{name}" valueReference="{50 + k}" causality="output" {more}/>'
        for k, (name, more) in enumerate(told.items())
    )
    variables = read_variables(read_fmu(write(tmp_path, more=more)))
    offsets = {name: variables[name].dimension[1] for name in told}
    assert offsets == {"T": 273.15, "dT": 0.0, "rise": 0.0, "T_of_type": 273.15}


def test_what_has_a_start_value(tmp_path):
    """No input or parameter, but settable before the start: `initial` is exact."""
    more = "".join(
        f'<Float64 name="{name}" valueReference="{41 + k}" causality="{causality}" {declared}/>'
        for k, (name, causality, declared) in enumerate(
            [
                ("speed", "local", 'initial="exact" start="0"'),
                ("share", "parameter", 'variability="fixed" initial="exact" start="0"'),
                ("guess", "local", 'initial="approx" start="0"'),
            ]
        )
    )
    variables = read_variables(read_fmu(write(tmp_path, more=more)))
    assert [name for name, v in variables.items() if v.starts] == ["speed"]


def test_index_of_a_derivative_stands_inside():
    assert element_name("der(x)", (2,)) == "der(x[2])"


def test_clocks_are_refused(tmp_path):
    clock = (
        '<Clock name="tick" valueReference="50" causality="input" intervalVariability="triggered"/>'
    )
    with pytest.raises(FmuError, match=r"x.fmu has Clock variables, which are not supported: tick"):
        read_fmu(write(tmp_path, more=clock))


def test_an_alias_without_a_name_is_refused(tmp_path):
    more = '<Float64 name="a" valueReference="50"><Dimension start="2"/><Alias/></Float64>'
    with pytest.raises(FmuError, match="the variable of reference 50 has no name"):
        read_fmu(write(tmp_path, more=more))


def test_model_exchange_only(tmp_path):
    file = write(tmp_path, "ModelExchange")
    with pytest.raises(
        FmuError, match=r"x.fmu is for model exchange only; co-simulation is needed"
    ):
        read_fmu(file)


def test_an_array_without_elements_takes_no_memory():
    """Its other sizes may be anything; their numbers once stood in memory before it was empty."""
    array = SimpleNamespace(
        name="m", shape=(0, 1 << 62), dimensions=["rows", "columns"], type="Float64"
    )
    model = SimpleNamespace(modelVariables=[array])
    assert read_elements(model) == []

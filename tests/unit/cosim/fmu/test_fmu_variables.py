"""Variables of an FMU 3.0 as the master sees them."""

import re
import zipfile

import fmpy
import pytest
from support.parts import FakePart

from herringbone.core import FmuError, StructureError
from herringbone.cosim.fmu.file import read_fmu
from herringbone.cosim.fmu.variables import read_elements, read_variables
from herringbone.cosim.structure.network import build_network
from herringbone.cosim.structure.system import PartSpec, System

KINDS = (
    "Float32", "Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64", "Boolean",
)  # fmt: skip


def write(folder, kind="CoSimulation"):
    others = "".join(
        f'<{k} name="{k}" valueReference="{20 + i}" causality="output"/>'
        for i, k in enumerate(KINDS)
    )
    text = f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="m" instantiationToken="t">
<{kind} modelIdentifier="model"/>
<UnitDefinitions><Unit name="mm"><BaseUnit m="1" factor="0.001"/></Unit></UnitDefinitions>
<ModelVariables>
<Float64 name="u" valueReference="3" causality="input" start="2" unit="mm"/>
<Float64 name="u.node" valueReference="4" causality="input" start="2" unit="mm">
<Dimension start="4"/></Float64>
<Float64 name="table" valueReference="8" causality="output"><Dimension start="2"/>
<Dimension start="3"/></Float64>
<Float64 name="y" valueReference="9" causality="output"/>
{others}
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
    assert numbers == {"u": 0, "u.node1": 1, "u.node2": 2, "u.node3": 3, "u.node4": 4, "y": 5}
    layout = [(e.variable.valueReference, e.first, e.size) for e in read_elements(model)]
    assert layout == [(3, 0, 1), *[(4, 1, 4)] * 4, (9, 5, 1)]


def test_what_is_declared(tmp_path):
    variables = read_variables(read_fmu(write(tmp_path)))
    assert variables["u"].causality == "input"
    assert variables["u.node2"].dimension == (0.001, 0.0, (("m", 1),))
    assert variables["y"].dependencies == {"u", "u.node"}
    assert variables["table"].type == "Float64[2, 3]"
    assert variables["file"].type == "String"
    assert [variables[kind].type for kind in KINDS] == list(KINDS)


@pytest.mark.parametrize(
    ("output", "kind"), [("table", "Float64[2, 3]"), ("Int32", "Int32"), ("Float32", "Float32")]
)
def test_only_scalars_of_double_precision_can_be_connected(output, kind, tmp_path):
    parts = [
        FakePart("p", read_variables(read_fmu(write(tmp_path)))), FakePart("q").real("u", "input")
    ]  # fmt: skip
    system = System("s", "", (PartSpec("p", "x"), PartSpec("q", "x")), ((f"p.{output}", "q.u"),))
    said = f"connection 'p.{output}' -> 'q.u': 'p.{output}' is of type {kind}; only scalars"
    with pytest.raises(StructureError, match=re.escape(said)):
        build_network(system, parts)


def test_model_exchange_only(tmp_path):
    file = write(tmp_path, "ModelExchange")
    with pytest.raises(
        FmuError, match=r"x.fmu is for model exchange only; co-simulation is needed"
    ):
        read_fmu(file)

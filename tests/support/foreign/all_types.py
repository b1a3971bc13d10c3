"""The FMU 3.0 of `tests/fmus/all_types.c`: its description, and the FMU with other abilities."""

from pathlib import Path

from support.foreign.c_fmu import compiled_fmu

SOURCE = Path(__file__).parents[2] / "fmus" / "all_types.c"
KINDS = (
    "Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64", "Boolean", "String",
    "Binary", "Enumeration", "Float32",
)  # fmt: skip
EVENTS = 'hasEventMode="true" mightReturnEarlyFromDoStep="true"'


def _pair(place: int, kind: str) -> str:
    """Input and output of a type."""
    more = {"Enumeration": ' declaredType="Gear"', "Float32": ' unit="mm"'}.get(kind, "")
    variability = "continuous" if kind == "Float32" else "discrete"
    start = {"Boolean": "false", "Enumeration": "1"}.get(kind, "0")
    given = f'start="{start}"/>'
    if kind in {"String", "Binary"}:
        given = f'><Start value=""/></{kind}>'
    return (
        f'<{kind} name="{kind}_in" valueReference="{10 * place}" causality="input"'
        f' variability="{variability}"{more} {given}'
        f'<{kind} name="{kind}_out" valueReference="{10 * place + 1}" causality="output"'
        f' variability="{variability}"{more}/>'
    )


def description(abilities: str = "") -> str:
    """modelDescription.xml with some attributes of CoSimulation."""
    pairs = "\n".join(_pair(place, kind) for place, kind in enumerate(KINDS, 1))
    vector = '<Dimension valueReference="200"/></Float64>'
    matrix = '<Dimension start="2"/><Dimension start="2"/></Float64>'
    two = '<Dimension start="2"/></Int32>'
    outputs = [*(10 * k + 1 for k in range(1, len(KINDS) + 1)), 202, 204, 206, 211, 215]
    structure = "".join(f'<Output valueReference="{r}"/>' for r in outputs)
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="all_types" instantiationToken="t">
<CoSimulation modelIdentifier="all_types" canHandleVariableCommunicationStepSize="true"
 canGetAndSetFMUState="true" {abilities}/>
<UnitDefinitions><Unit name="mm"><BaseUnit m="1" factor="1e-3"/></Unit></UnitDefinitions>
<TypeDefinitions><EnumerationType name="Gear"><Item name="first" value="1"/>
<Item name="second" value="2"/></EnumerationType></TypeDefinitions>
<ModelVariables>
<Float64 name="time" valueReference="999" causality="independent"/>
{pairs}
<UInt64 name="n" valueReference="200" causality="structuralParameter" variability="fixed"
 start="2"/>
<Float64 name="u" valueReference="201" causality="input" start="0 0">{vector}
<Float64 name="y" valueReference="202" causality="output">{vector}
<Float64 name="m" valueReference="203" causality="parameter" variability="fixed"
 start="1 2 3 4">{matrix}
<Float64 name="turned" valueReference="204" causality="output">{matrix}
<Int32 name="pair" valueReference="205" causality="input" start="0 0">{two}
<Int32 name="swapped" valueReference="206" causality="output">{two}
<Float64 name="every" valueReference="210" causality="parameter" variability="fixed" start="0"/>
<Int32 name="events" valueReference="211" causality="output"/>
<Float64 name="end" valueReference="212" causality="parameter" variability="fixed" start="0"/>
<Float64 name="restless" valueReference="213" causality="parameter" variability="fixed" start="0"/>
<Float64 name="told" valueReference="216" causality="parameter" variability="fixed" start="0"/>
<Float64 name="d" valueReference="214" causality="input" variability="discrete" start="0"/>
<Float64 name="d_out" valueReference="215" causality="output" variability="discrete"/>
</ModelVariables>
<ModelStructure>{structure}</ModelStructure>
</fmiModelDescription>
"""


def build_all_types(folder: Path, abilities: str = "") -> Path:
    """The FMU, built in a folder."""
    return compiled_fmu(SOURCE, description(abilities), folder)

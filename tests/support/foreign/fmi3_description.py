"""Descriptions of FMI 3.0 from those of FMI 2.0 that tests write for their C sources."""

import xml.etree.ElementTree as ET
from pathlib import Path

from support.foreign.c_fmu import compiled_fmu

_NAMES = {"canGetAndSetFMUstate": "canGetAndSetFMUState"}


def as_fmi3(description: str, abilities: str = "", within: tuple[str, ...] = ()) -> str:
    """modelDescription.xml of FMI 3.0 with the same variables, all Float64.

    Args:
        description: of FMI 2.0, whose variables are all Real.
        abilities: further attributes of CoSimulation.
        within: inputs that are given within a step.
    """
    root = ET.fromstring(description)
    kind = root.find("CoSimulation")
    given = _attributes({_NAMES.get(k, k): v for k, v in kind.attrib.items()})
    variables = root.findall("ModelVariables/ScalarVariable")
    units = root.find("UnitDefinitions")
    told = "" if units is None else ET.tostring(units, encoding="unicode")
    lines = [_variable(v, update=v.get("name") in within) for v in variables]
    outputs = [_output(u, variables) for u in root.findall("ModelStructure/Outputs/Unknown")]
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="{root.get("modelName")}" instantiationToken="t">
<CoSimulation {given} {abilities}/>
{told}
<ModelVariables>
<Float64 name="time" valueReference="999" causality="independent"/>
{"".join(lines)}
</ModelVariables>
<ModelStructure>{"".join(outputs)}</ModelStructure>
</fmiModelDescription>
"""


def c_part(
    source: Path, description: str, folder: Path, defines: tuple[str, ...] = (), *, fmi: int
) -> Path:
    """The FMU of a C source that knows both versions; see `compiled_fmu`."""
    if fmi == 2:
        return compiled_fmu(source, description, folder, defines)
    return compiled_fmu(source, as_fmi3(description), folder, (*defines, "FMI3"))


def _variable(variable: ET.Element, *, update: bool) -> str:
    told = {**variable.attrib, **variable.find("Real").attrib}
    if update:
        told |= {"intermediateUpdate": "true"}
    return f"<Float64 {_attributes(told)}/>"


def _attributes(given: dict[str, str]) -> str:
    return " ".join(f'{name}="{value}"' for name, value in given.items())


def _output(unknown: ET.Element, variables: list[ET.Element]) -> str:
    def reference(index: str) -> str:
        return variables[int(index) - 1].get("valueReference")

    passed = unknown.get("dependencies")
    on = "" if passed is None else " ".join(map(reference, passed.split()))
    more = "" if passed is None else f' dependencies="{on}"'
    return f'<Output valueReference="{reference(unknown.get("index"))}"{more}/>'

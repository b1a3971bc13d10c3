"""FMUs of which only the description is ever read."""

import zipfile

import fmpy

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
    identifier, third = file.stem, fmi_version.startswith("3.")
    token = "instantiationToken" if third else "guid"
    platform = fmpy.platform_tuple if third else fmpy.platform
    description = f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="{fmi_version}" modelName="{identifier}" {token}="{identifier}">
<CoSimulation modelIdentifier="{identifier}"/>
<UnitDefinitions><Unit name="N"><BaseUnit {newton}/></Unit>
<Unit name="degC"><BaseUnit K="1" offset="273.15"/></Unit>
<Unit name="m"><BaseUnit m="1"/></Unit><Unit name="kg"><BaseUnit kg="1"/></Unit></UnitDefinitions>
<ModelVariables>{variables}</ModelVariables><ModelStructure/></fmiModelDescription>"""
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr(zipfile.ZipInfo("modelDescription.xml"), description)
        library = f"binaries/{platform}/{identifier}{fmpy.sharedLibraryExtension}"
        archive.writestr(zipfile.ZipInfo(library), b"")
    return file

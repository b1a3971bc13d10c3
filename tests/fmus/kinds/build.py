"""Builds the FMUs of the folders beside this file into the folder given.

    python build.py FOLDER [NAME ...]

Python slaves by pythonfmu, C sources by the C compiler. What pythonfmu cannot write is put into
modelDescription.xml here, from `parts.toml` in each folder: units, dependencies of the outputs,
derivatives, flags (capabilities), all optional; of C sources also inputs, outputs and parameters,
in the order of the value references. Needs nothing of herringbone.
"""

import shutil
import subprocess
import sys
import tempfile
import tomllib
import xml.etree.ElementTree as ET
import zipfile
from math import pi
from pathlib import Path

import fmpy
from pythonfmu.builder import FmuBuilder

HERE = Path(__file__).resolve().parent
UNITS = {
    "N": {"kg": 1, "m": 1, "s": -2},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "m": {"m": 1},
    "m/s": {"m": 1, "s": -1},
    "km/h": {"m": 1, "s": -1, "factor": 1 / 3.6},
    "rad": {"rad": 1},
    "rad/s": {"rad": 1, "s": -1},
    "1/min": {"rad": 1, "s": -1, "factor": pi / 30},
    "kg": {"kg": 1},
    "N.s/m": {"kg": 1, "s": -1},
}
PARTS = {
    name: (family.parent / name, part)
    for family in sorted(HERE.glob("*/parts.toml"))
    for name, part in tomllib.loads(family.read_text(encoding="utf-8")).items()
}
"""By name of the source: where it lies, and what goes into its description."""


def c_description(name: str, part: dict) -> ET.Element:
    """The description of a C source, without what `complete` adds."""
    root = ET.Element("fmiModelDescription", fmiVersion="2.0", modelName=name, guid=f"{{{name}}}")
    ET.SubElement(
        root, "CoSimulation", modelIdentifier=name, canHandleVariableCommunicationStepSize="true"
    )
    variables = ET.SubElement(root, "ModelVariables")
    outputs = ET.SubElement(ET.SubElement(root, "ModelStructure"), "Outputs")

    def add(variable, causality, start=None, **attributes):
        reference = str(len(variables))
        scalar = ET.SubElement(
            variables,
            "ScalarVariable",
            {"name": variable, "valueReference": reference, "causality": causality, **attributes},
        )
        ET.SubElement(scalar, "Real", {} if start is None else {"start": repr(start)})
        if causality == "output":
            ET.SubElement(outputs, "Unknown", index=str(len(variables)))

    for variable in part["inputs"]:
        add(variable, "input", 0.0)
    for variable in part["outputs"]:
        add(variable, "output")
    for variable, start in part.get("parameters", {}).items():
        add(variable, "parameter", start, variability="fixed")
    return root


def complete(root: ET.Element, part: dict) -> None:
    """Writes capabilities, units, derivatives and dependencies into a description."""
    root.find("CoSimulation").attrib.update(part.get("flags", {}))
    scalars = root.findall("ModelVariables/ScalarVariable")
    index = {scalar.get("name"): str(i) for i, scalar in enumerate(scalars, 1)}
    reals = {scalar.get("name"): scalar.find("Real") for scalar in scalars}
    units = part.get("units", {})
    if units:
        definitions = ET.Element("UnitDefinitions")
        for unit in sorted(set(units.values())):
            entry = ET.SubElement(definitions, "Unit", name=unit)
            base = {key: repr(value) for key, value in UNITS[unit].items()}
            ET.SubElement(entry, "BaseUnit", base)
        root.insert(1, definitions)
    for name, unit in units.items():
        reals[name].set("unit", unit)
    for name, of in part.get("derivatives", {}).items():
        reals[name].set("derivative", index[of])
    unknowns = root.findall("ModelStructure/Outputs/Unknown")
    names = {i: name for name, i in index.items()}
    for unknown in unknowns:
        inputs = part.get("dependencies", {}).get(names[unknown.get("index")])
        if inputs is not None:
            unknown.set("dependencies", " ".join(sorted((index[i] for i in inputs), key=int)))
    initial = ET.SubElement(root.find("ModelStructure"), "InitialUnknowns")
    for unknown in unknowns:
        ET.SubElement(initial, "Unknown", index=unknown.get("index"))


def text(root: ET.Element) -> str:
    ET.indent(root)
    return ET.tostring(root, encoding="unicode", xml_declaration=True)


def build_python(source: Path, part: dict, folder: Path) -> Path:
    stock = Path(FmuBuilder.build_FMU(source, dest=folder))
    draft = stock.rename(stock.with_suffix(".draft"))
    with zipfile.ZipFile(draft) as old, zipfile.ZipFile(stock, "w", zipfile.ZIP_DEFLATED) as new:
        for item in old.namelist():
            data = old.read(item)
            if item == "modelDescription.xml":
                root = ET.fromstring(data)
                complete(root, part)
                data = text(root)
            new.writestr(item, data)
    draft.unlink()
    return stock


def build_c(source: Path, part: dict, folder: Path) -> Path:
    root = c_description(source.stem, part)
    complete(root, part)
    file = folder / f"{source.stem}.fmu"
    with tempfile.TemporaryDirectory() as scratch:
        library = Path(scratch) / f"{source.stem}{fmpy.sharedLibraryExtension}"
        command = [shutil.which("gcc") or "cc", "-O2", "-shared", "-fPIC", "-o", library, source]
        subprocess.run(command, check=True)
        with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("modelDescription.xml", text(root))
            archive.write(library, f"binaries/{fmpy.platform}/{library.name}")
    return file


def build(name: str, folder: Path) -> Path:
    """Builds the FMU of one source, named as in PARTS."""
    make = build_c if name.endswith(".c") else build_python
    return make(*PARTS[name], folder)


def main(folder: str, *names: str) -> None:
    """Builds some FMUs, or all; in a process of its own, because building imports the slaves."""
    Path(folder).mkdir(parents=True, exist_ok=True)
    sys.dont_write_bytecode = True
    for name in names or PARTS:
        build(name, Path(folder).resolve())


if __name__ == "__main__":
    main(*sys.argv[1:])

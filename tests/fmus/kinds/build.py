"""Builds the FMUs of this folder into the folder given.

    python build.py FOLDER [NAME ...]

Python slaves by pythonfmu, C sources by the C compiler. What pythonfmu cannot write (units,
dependencies, capabilities) is put into modelDescription.xml here. Needs nothing of herringbone.
"""

import shutil
import subprocess
import sys
import tempfile
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
SAVES = {"canGetAndSetFMUstate": "true"}
SERIALIZES = {**SAVES, "canSerializeFMUstate": "true"}
ONCE = {"canBeInstantiatedOnlyOncePerProcess": "true"}
STRICT = {"canHandleVariableCommunicationStepSize": "false"}
PARTS = {
    # by source: units, dependencies of the outputs, derivatives, capabilities; all optional
    "linear_carriage.py": {
        "units": {
            "mass": "kg",
            "viscous": "N.s/m",
            "force_in": "N",
            "position": "m",
            "velocity": "m/s",
        },
        "dependencies": {"position": [], "velocity": []},
        "derivatives": {"velocity": "position"},
        "flags": SERIALIZES,
    },
    "torsion_spring.py": {
        "units": {
            "flange_a.phi": "rad",
            "flange_b.phi": "rad",
            "flange_a.tau": "N.m",
            "flange_b.tau": "N.m",
        },
        "dependencies": {
            "flange_a.tau": ["flange_a.phi", "flange_b.phi"],
            "flange_b.tau": ["flange_a.phi", "flange_b.phi"],
        },
        "flags": SAVES,
    },
    # wrong on purpose: the force depends on all four inputs
    "engine_mount.py": {
        "units": {
            "s_top": "m",
            "s_bottom": "m",
            "v_top": "m/s",
            "v_bottom": "m/s",
            "force": "N",
        },
        "dependencies": {"force": []},
        "flags": SAVES,
    },
    "e_drive.py": {
        "units": {
            "torque_set": "N.m",
            "flange.phi": "rad",
            "flange.w": "rad/s",
            "flange.tau": "N.m",
            "rotor_speed_rpm": "1/min",
        },
        "dependencies": {"flange.tau": ["flange.phi", "flange.w"], "rotor_speed_rpm": []},
        "flags": SERIALIZES,
    },
    "road_vehicle.py": {
        "units": {
            "gearbox.phi": "rad",
            "gearbox.w": "rad/s",
            "gearbox.tau": "N.m",
            "speed_kmh": "km/h",
            "distance": "m",
        },
        "flags": SAVES,
    },
    "speed_governor.py": {
        "units": {"speed_set": "1/min", "speed_rpm": "1/min", "torque_cmd": "N.m"},
        "dependencies": {"torque_cmd": ["speed_set", "speed_rpm"]},
        "flags": SAVES,
    },
    "bus_delay.py": {"flags": SERIALIZES},
    "ecu_task.py": {
        "units": {"w_ref": "rad/s", "w_meas": "rad/s", "torque_request": "N.m"},
        "flags": SAVES,
    },
    "dog_clutch.py": {
        "units": {"delta_phi": "rad", "delta_w": "rad/s", "torque": "N.m"},
        "flags": SAVES,
    },
    "wheel_speed_sensor.py": {
        "units": {"w_true": "rad/s", "w_sensed": "rad/s"},
        "dependencies": {"w_sensed": ["w_true"]},
        "flags": SAVES,
    },
    "fixed_step_rotor.py": {
        "units": {"flange.tau": "N.m", "flange.phi": "rad", "flange.w": "rad/s"},
        "dependencies": {"flange.phi": [], "flange.w": []},
        "flags": SAVES,
    },
    "single_flywheel.py": {
        "units": {"tau_shaft": "N.m", "omega": "rad/s", "angle": "rad"},
        "flags": ONCE,
    },
    "hydraulic_slide.py": {
        "units": {"force_cmd": "N", "stroke": "m", "speed": "m/s"},
        "dependencies": {"stroke": [], "speed": []},
        "flags": SAVES,
    },
    "rubber_bushing.py": {"flags": SAVES},
    "servo_valve.py": {"dependencies": {"opening": []}, "flags": SAVES},
    "trolley.py": {"units": {"pull": "N", "x_out": "m", "v_out": "m/s"}, "flags": SAVES},
    "lift_cage.py": {
        "units": {"f": "N", "s": "m", "v": "m/s"},
        "dependencies": {"s": [], "v": []},
        "derivatives": {"v": "s"},
        "flags": SAVES,
    },
    "press_ram.py": {
        "units": {"ram_force": "N", "ram_pos": "m", "ram_vel": "m/s"},
        "flags": {**STRICT, **SAVES},
    },
    # C sources: also inputs, outputs and parameters, in the order of the value references
    "c_carriage.c": {
        "inputs": ["force"],
        "outputs": ["s", "v"],
        "parameters": {"mass": 12.0},
        "units": {"force": "N", "s": "m", "v": "m/s", "mass": "kg"},
        "derivatives": {"v": "s"},
        "flags": SAVES,
    },
    "c_spring_damper.c": {
        "inputs": ["x1", "x2", "v1", "v2"],
        "outputs": ["f1", "f2"],
        "dependencies": {"f1": ["x1", "x2", "v1", "v2"], "f2": ["x1", "x2", "v1", "v2"]},
        "flags": SAVES,
    },
    "c_e_drive.c": {
        "inputs": ["torque_set", "flange.phi", "flange.w"],
        "outputs": ["flange.tau", "rotor_w"],
        "parameters": {"slip": 0.0},
        "units": {
            "torque_set": "N.m",
            "flange.phi": "rad",
            "flange.w": "rad/s",
            "flange.tau": "N.m",
            "rotor_w": "rad/s",
        },
        "flags": SAVES,
    },
    "c_slip_motor.c": {
        "inputs": ["flange.phi", "flange.w"],
        "outputs": ["flange.tau", "rotor_w"],
        "parameters": {"synchronous": 100.0, "breakdown": 900.0, "slip": 0.12, "w0": 0.0},
        "units": {
            "flange.phi": "rad",
            "flange.w": "rad/s",
            "flange.tau": "N.m",
            "rotor_w": "rad/s",
        },
        "flags": SAVES,
    },
    "c_fan.c": {
        "inputs": ["flange.w"],
        "outputs": ["flange.tau"],
        "parameters": {"share": 1.0},
        "units": {"flange.w": "rad/s", "flange.tau": "N.m"},
        "flags": SAVES,
    },
    "oscillator_mass.c": {
        "inputs": ["f", "xo", "vo"],
        "outputs": ["x", "v", "fo"],
        "parameters": {"m": 1.0, "k": 0.0, "c": 0.0, "ko": 0.0, "co": 0.0, "x0": 0.0, "v0": 0.0},
        "flags": SAVES,
    },
    "oscillator_curve.c": {
        "inputs": ["f", "xo", "vo"],
        "outputs": ["x", "v", "fo"],
        "parameters": {"m": 1.0, "k": 0.0, "c": 0.0, "ko": 0.0, "co": 0.0, "x0": 0.0, "v0": 0.0},
        "flags": {**SAVES, "canInterpolateInputs": "true", "maxOutputDerivativeOrder": "1"},
    },
    "oscillator_play.c": {
        "inputs": ["xo"],
        "outputs": ["x", "v", "fo"],
        "parameters": {"m": 1.0, "k": 0.0, "ko": 0.0, "gap": 0.0, "x0": 0.0, "v0": 0.0},
        "flags": SAVES,
    },
    "oscillator_spring.c": {
        "inputs": ["xa", "va", "xb", "vb"],
        "outputs": ["fa", "fb"],
        "parameters": {"k": 100.0, "c": 0.0},
        "flags": SAVES,
    },
    "c_speed_governor.c": {
        "inputs": ["w_set", "w_act"],
        "outputs": ["torque"],
        "parameters": {"kp": 7.5, "ki": 60.0},
        "units": {"w_set": "rad/s", "w_act": "rad/s", "torque": "N.m"},
        "flags": SAVES,
    },
    "c_bus_delay.c": {
        "inputs": ["u"],
        "outputs": ["y"],
        "dependencies": {"y": []},
        "flags": SAVES,
    },
    "c_ecu_task.c": {
        "inputs": ["w_ref", "w_meas"],
        "outputs": ["torque_request"],
        "units": {"w_ref": "rad/s", "w_meas": "rad/s", "torque_request": "N.m"},
        "flags": SAVES,
    },
    "c_fixed_step_rotor.c": {
        "inputs": ["tau"],
        "outputs": ["phi", "w"],
        "units": {"tau": "N.m", "phi": "rad", "w": "rad/s"},
        "flags": SAVES,
    },
    "c_single_flywheel.c": {
        "inputs": ["tau"],
        "outputs": ["omega", "angle"],
        "units": {"tau": "N.m", "omega": "rad/s", "angle": "rad"},
        "flags": {**ONCE, **SAVES},
    },
    "c_hydraulic_slide.c": {
        "inputs": ["force_cmd"],
        "outputs": ["stroke", "speed"],
        "units": {"force_cmd": "N", "stroke": "m", "speed": "m/s"},
        "flags": SAVES,
    },
    "c_press_ram.c": {
        "inputs": ["force"],
        "outputs": ["pos", "vel"],
        "flags": {**STRICT, **SAVES},
    },
}


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
    return make(HERE / name, PARTS[name], folder)


def main(folder: str, *names: str) -> None:
    """Builds some FMUs, or all; in a process of its own, because building imports the slaves."""
    Path(folder).mkdir(parents=True, exist_ok=True)
    sys.dont_write_bytecode = True
    for name in names or PARTS:
        build(name, Path(folder).resolve())


if __name__ == "__main__":
    main(*sys.argv[1:])

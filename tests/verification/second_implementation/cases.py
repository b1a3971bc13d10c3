"""What is compared: few runs, each of which combines several paths of the equations.

Left and right, drive and coast differ in tables and harmonics; most phases of the right table are
no nodes of the force law.
"""

import math
from typing import NamedTuple

import numpy as np

from second_implementation.product import FMUS

LOADED, CONTACT_CHANGES = 1e-7, 1e-6
"""Largest deviation over a group's alternating part."""
_RIGHT_PHASES = 48
_TABLE = FMUS / "gear_mesh" / "resources" / "mesh_stiffness.csv"
_ERRORS = """# units: order 1, amplitude m, phase rad
side,flank,gear,order,amplitude,phase
left,drive,pinion,27,0.3e-6,0.4
left,drive,pinion,1,2e-6,1.0
left,drive,wheel,81,0.2e-6,-0.3
right,drive,pinion,27,0.25e-6,1.4
right,drive,wheel,3,1e-6,2.0
left,coast,pinion,54,0.1e-6,0.7
left,coast,wheel,2,1.5e-6,0.1
right,coast,pinion,27,0.3e-6,0.0
right,coast,wheel,81,0.1e-6,0.9
"""
_PAIR = FMUS / "gear_mesh" / "gear_pair.toml"
_DEVIATIONS = """
[deviations]
grade = 6
seed = 1
"""
_CYCLE = """# units: time s, speed rad/s, torque N.m
time,speed,torque
0.0005,0,40
0.002,4,120
0.0035,-2,60
"""

ERRORS = {
    "gear_mesh.stiffness_table": "table.csv",
    "gear_mesh.tooth_errors": "errors.csv",
    "gear_mesh.ramp_turns": 0.0,
}
TEETH = {
    **ERRORS,
    "gear_mesh.symmetry_deviation": 10e-6,
    "gear_mesh.stagger": 0.37,
    "gear_mesh.impact_force": 150.0,
    "gear_mesh.impact_duration": 0.3,
}
SHAFTS = {
    "gear_mesh.pinion.torque_share_left": 0.3,
    "gear_mesh.wheel.torque_share_left": 0.65,
    "gear_mesh.pinion.unbalance": 2e-4,
    "gear_mesh.pinion.unbalance_phase": 0.7,
    "gear_mesh.wheel.unbalance": 3e-3,
    "gear_mesh.wheel.unbalance_phase": -1.1,
    "gear_mesh.pinion_restraint": 2e7,
    "gear_mesh.pinion_axial_drag": 80.0,
}
BEARINGS = {
    "bearing_supports.pinion.radial_clearance": 10e-6,
    "bearing_supports.wheel.radial_clearance": 60e-6,  # their damping is rising: 3 um into it
    "bearing_supports.pinion.axial_stiffness": 1e6,
    "bearing_supports.pinion.axial_damping": 200.0,
    "bearing_supports.axial_per_shaft": 1.0,
}
EVERY = {**TEETH, **SHAFTS, **BEARINGS}
RAMP, QUICK = {"gear_mesh.ramp_turns": 0.02}, {"gear_mesh.ramp_turns": 0.01}
"""Over after 1.2 ms and 0.6 ms at 1000 r/min."""
BACKWARDS = {"gear_mesh.der(angle)": -212.3}
KICK = {"gear_mesh.der(angle)": 3.0, "gear_mesh.der(approach)": 0.150894}
"""The pinion 3 rad/s too fast; both meshes leave contact and come back."""
MOTORS = {"gear_mesh.drag_torque": 1.5, "load_motor.viscous_friction": 0.2}
RUN_UP = {
    **MOTORS,
    "bench_controller.cycle": "cycle.csv",
    "bench_controller.speed_factor": 0.9,
    "bench_controller.torque_factor": 1.1,
    "bench_controller.load_ramp_time": 2e-3,
    "drive_motor.maximum_acceleration": 800.0,
    "drive_motor.torque_limit": 30.0,
}


class Case(NamedTuple):
    """A run, and how near both implementations are.

    Attributes:
        system, values, scene, start, offset, t_end, gear: see `product.run`.
        bound: largest deviation, over the group's alternating part.
    """

    system: str
    values: dict
    bound: float = LOADED
    scene: str | None = None
    start: str | None = None
    offset: dict | None = None
    t_end: float = 3e-3
    gear: str | None = None


def _torque(pinion):
    return {"gear_mesh.pinion.tau": pinion}


CASES = {
    "gearbox": Case("gearbox", EVERY),
    "gearbox, ramp": Case("gearbox", {**EVERY, **RAMP}),
    "gearbox, ramp, turning backwards": Case(
        "gearbox", {**EVERY, **RAMP}, offset=BACKWARDS, t_end=1e-3
    ),
    "gearbox, single teeth": Case("gearbox", EVERY, t_end=1.5e-3, gear="pair.toml"),
    "gearbox, single teeth, coast": Case(
        "gearbox",
        {**EVERY, **_torque(-150.0), "gear_mesh.tooth_deviations": "coast_teeth.csv"},
        t_end=8e-4, gear="pair.toml",
    ),
    "gearbox, single teeth, ramp": Case(
        "gearbox", {**ERRORS, **SHAFTS, **QUICK}, CONTACT_CHANGES, t_end=7e-4, gear="pair.toml"
    ),
    "gearbox, coast": Case("gearbox", {**EVERY, **_torque(-150.0)}),
    "gearbox, deflections below the damping's transition": Case(
        "gearbox", {**TEETH, **SHAFTS, **_torque(20.0)}
    ),
    "gearbox, above the table": Case("gearbox", {**TEETH, **SHAFTS, **_torque(4900.0)}),
    "gearbox, separation": Case(
        "gearbox", {**TEETH, **SHAFTS, **_torque(150.0)}, CONTACT_CHANGES, offset=KICK
    ),
    "gearbox, ungated damping, backlash crossed": Case(
        "gearbox",
        {**TEETH, **SHAFTS, **_torque(100.0), "gear_mesh.damping_gate": 0.0,
         "gear_mesh.backlash": 20e-6},
        CONTACT_CHANGES, offset=KICK,
    ),
    "rig": Case("test_rig", {**EVERY, **MOTORS}),
    "rig, coast": Case("test_rig", {**EVERY, **MOTORS, "bench_controller.torque_factor": -0.7}),
    "rig, turning backwards": Case(
        "test_rig", {**EVERY, **MOTORS, "bench_controller.speed_factor": -1.0}
    ),
    "rig, separation": Case("test_rig", {**EVERY, **MOTORS}, CONTACT_CHANGES, scene="separation"),
    "rig, run-up": Case(
        "test_rig", {**TEETH, **SHAFTS, **RUN_UP}, CONTACT_CHANGES, start="rest", t_end=5e-3
    ),
}  # fmt: skip


def write_files(folder):
    """The files that the cases name, by name."""
    contents = {
        "table.csv": _table(),
        "errors.csv": _ERRORS,
        "cycle.csv": _CYCLE,
        "pair.toml": _pair(),
        "coast_teeth.csv": _coast_teeth(),
    }
    for name, content in contents.items():
        (folder / name).write_text(content, encoding="utf-8")
    return {name: str(folder / name) for name in contents}


def _pair():
    """The shipped pair, its teeth of class 6; the law of a pair of teeth by a quick method."""
    text = _PAIR.read_text(encoding="utf-8")
    return text.replace('"fe"', '"coupled-slices"\nphases = 8') + _DEVIATIONS


def _coast_teeth():
    """Deviations of teeth on the coast flank of the left half."""
    rows = ["# units: tooth 1, position m, profile m, helix m",
            "side,flank,gear,tooth,position,profile,helix"]  # fmt: skip
    for gear, z in (("pinion", 27), ("wheel", 81)):
        for n in range(z):
            values = 5e-6 * math.sin(2.1 * n), 3e-6 * math.cos(1.3 * n), 4e-6 * math.sin(0.7 * n)
            rows.append(",".join(map(str, ("left", "coast", gear, n + 1, *values))))
    return "\n".join(rows) + "\n"


def _table():
    """The shipped table; its right mesh is softer, and has other phases with another course."""
    lines = _TABLE.read_text(encoding="utf-8").splitlines()
    kept = [line for line in lines if not line.startswith("right,")]
    loads = sorted({line.split(",")[1] for line in lines if line.startswith("right,")}, key=float)
    for load in loads:
        rows = [line.split(",") for line in lines if line.startswith(f"right,{load},")]
        phases, stiffness = np.array([[float(phase), float(k)] for _, _, phase, k in rows]).T
        for phase in np.arange(_RIGHT_PHASES) / _RIGHT_PHASES:
            factor = 0.93 + 0.03 * math.cos(2.0 * math.pi * (phase - 0.2))
            k = factor * np.interp(phase, phases, stiffness, period=1.0)
            kept.append(f"right,{load},{float(phase)!r},{float(k)!r}")
    return "\n".join(kept) + "\n"

"""The product's runs: parameters, resources, start values and outputs, by its public functions."""

from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

import herringbone as hb
from herringbone.running.prepared import Wishes, prepared
from herringbone.scenes import Start
from second_implementation.assembly import Gearbox, Rig
from second_implementation.bearings import Bearings
from second_implementation.drivetrain import Drivetrain
from second_implementation.gear_pair import GearPair
from second_implementation.housing import AXES, SEATS, Housing

MICRO_STEP, STEP, RECORDS = 0.25e-6, 0.5e-6, 20e-6
"""Of every part, of the coupling (li, degree 2) and between records [s]."""
FMUS = Path(__file__).parents[3] / "fmus"
_COORDINATES = [*(f"{axis}_{k}" for axis in "yz" for k in (1, 2, 3, 4)),
                "angle", "pinion_twist", "approach", "wheel_twist"]  # fmt: skip


class Given(NamedTuple):
    """What a run of the product was given.

    Attributes:
        result: the run.
        parameters: all of them, by part (without the systems around it) and name.
        files: resource files by the name of their parameter.
        values: start values and inputs that are not zero, by part and name.
    """

    result: hb.Result
    parameters: dict[str, dict[str, float]]
    files: dict[str, Path]
    values: dict[str, dict[str, float]]


def run(system, t_end, values, scene=None, start=None, offset=None, gear=None):
    """Run the product.

    Args:
        system, t_end, values, scene, start: as in `herringbone.run`.
        offset: added to start values, the scene's if not given.
        gear: gear file.
    """
    parts = ["gear_mesh"] if system == "gearbox" else ["gear_mesh", "drive_motor", "load_motor"]
    fine = {f"{part}.micro_step": MICRO_STEP for part in parts}
    wishes = Wishes(t_end, RECORDS, start, {**fine, **values}, start_offset=offset, gear=gear)
    structure, chosen, _ = prepared(system, scene, wishes)
    as_it_stands = replace(chosen, start=Start.REST, values={}, start_offset={})
    result = hb.run(
        structure, scene=as_it_stands, algorithm="li:degree=2", step=STEP, fmu="in-process"
    )
    parameters, files = {}, {}
    for part, component in result.info.model.items():
        parameters[_short(part)] = _below(part, result.info.parameters)
        for name, file in _below(part, result.info.resources).items():
            files[name] = FMUS / component / "resources" / file
    started = {_short(part.name): dict(part.values) for part in structure.parts}
    return Given(result, parameters, files, started)


def second(given):
    """The second implementation with the same parameters, files and torques."""
    parameters, files, values = given.parameters, given.files, given.values["gear_mesh"]
    first_angle = values.get("angle", 0.0) + values.get("pinion_twist", 0.0) / 2.0
    gear = GearPair(parameters["gear_mesh"], files, first_angle)
    parts = gear, Bearings(parameters["bearing_supports"]), Housing(files["modes"], files["shapes"])
    if "drive_motor" in parameters:
        return Rig(*parts, Drivetrain(parameters, files["cycle"]))
    return Gearbox(*parts, (values["pinion.tau"], values["wheel.tau"]))


def start_state(given, model):
    """State of the second implementation at the product's start values."""
    at = given.values
    gear = [at["gear_mesh"].get(name, 0.0) for name in _COORDINATES]
    gear += [at["gear_mesh"].get(f"der({name})", 0.0) for name in _COORDINATES]
    loads = [
        at["modal_housing"].get(f"start.{seat}.f_{axis}", 0.0) for seat in SEATS for axis in AXES
    ]
    modes = model.housing.at_rest(np.array(loads))
    outer = []
    if isinstance(model, Rig):
        drive, load = at["drive_motor"], at["load_motor"]
        angles, speeds = model.gear.flanges(gear[:12]), model.gear.flanges(gear[12:])
        outer = [
            drive.get("angle", 0.0) - angles[0],
            drive.get("speed", 0.0) - speeds[0],
            drive.get("integral", 0.0),
            drive.get("speed_reference", 0.0),
            angles[1] - load.get("angle", 0.0),
            speeds[1] - load.get("speed", 0.0),
            load.get("braking_torque", 0.0),
        ]
    return np.array([*gear, *modes, *np.zeros(modes.size), *outer])


def _short(path):
    """Name of a part without the systems around it."""
    return str(path).rsplit(".", 1)[-1]


def _below(part, values):
    """What belongs to a part, by name."""
    prefix = f"{part}."
    return {name.removeprefix(prefix): v for name, v in values.items() if name.startswith(prefix)}

"""Synthetic results with the columns of the shipped systems, for tests of plots and reports."""

import math
from dataclasses import dataclass

import numpy as np
import pandas as pd

from herringbone.analysis.anatomy import anatomy
from herringbone.components.ports import HALVES
from herringbone.components.registry import COMPONENTS
from herringbone.core import Outcome, OutcomeKind
from herringbone.core.declaring.variable import Causality
from herringbone.core.places.part_path import PartPath
from herringbone.cosim.structure.system_file import read_system
from herringbone.result.result import Result
from herringbone.result.run_info import RunInfo

SPEED = 1000.0 * 2.0 * math.pi / 60.0
"""Pinion speed [rad/s]."""
MESH_FREQUENCY = 450.0
"""Of 27 teeth at 1000 r/min [Hz]."""
TORQUE = 200.0
"""Pinion torque [N m]."""


@dataclass(frozen=True)
class Tone:
    """mean + amplitude * (sin(f_m) + 0.4 sin(2 f_m)) + slow * sin(pinion order), SI units."""

    mean: float
    amplitude: float
    slow: float = 0.0
    phase: float = 0.0

    def __call__(self, time: np.ndarray) -> np.ndarray:
        """Values at the times [s]."""
        mesh = 2.0 * math.pi * MESH_FREQUENCY * time + self.phase
        turn = SPEED * time + self.phase
        wave = np.sin(mesh) + 0.4 * np.sin(2.0 * mesh)
        return self.mean + self.amplitude * wave + self.slow * np.sin(turn)


def _tones() -> dict[str, Tone]:
    power = TORQUE * SPEED
    found = {
        "gear_mesh.pinion.w": Tone(SPEED, 1e-3, 1e-3),
        "gear_mesh.wheel.w": Tone(SPEED / 3.0, 1e-4, 1e-4),
        "gear_mesh.mesh_left.force": Tone(2262.0, 40.0, 5.0),
        "gear_mesh.mesh_right.force": Tone(2242.0, 40.0, 5.0, 0.5),
        "drive_coupling.torque": Tone(TORQUE, 0.3, 0.1),
        "drive_motor.torque": Tone(TORQUE, 0.01, 0.05),
        "drive_motor.flange.w": Tone(SPEED, 1e-4, 1e-3),
        "drive_motor.electrical_power": Tone(power / 0.93, 1.0, 5.0),
        "load_coupling.torque": Tone(3.0 * TORQUE - 2.0, 0.5, 0.2),
        "load_motor.torque": Tone(3.0 * TORQUE - 2.0, 0.0),
        "load_motor.flange.w": Tone(SPEED / 3.0, 1e-5, 1e-4),
        "load_motor.recovered_power": Tone(0.93 * (power - 70.0), 0.5),
        "load_motor.loss_power": Tone(0.07 * (power - 70.0), 0.1),
    }
    for i, half in enumerate(HALVES):
        sign, side = (-1.0 if i < 2 else 1.0), (1.0 if i % 2 == 0 else -1.0)
        mean = -sign * 1988.0
        found[f"bearing_supports.shaft.{half}.f_y"] = Tone(mean + 3.0 * i, 12.0, 1.0, 0.3 * i)
        axial = 0.0 if i < 2 else side * 4.0
        found[f"bearing_supports.shaft.{half}.f_z"] = Tone(axial, 0.8, 0.4, 0.3 * i)
        for k, axis in enumerate("xyz"):
            tone = Tone(0.0, (3e-5, 6e-5, 5e-6)[k] * (1.0 + 0.2 * i), 1e-6, 0.4 * i + k)
            found[f"modal_housing.{half}.v_{axis}"] = tone
    return found


def _tone(tones: dict[str, Tone], part: PartPath, variable: str) -> Tone:
    """Of a column, whatever system contains its part."""
    return tones.get(f"{part.name}.{variable}", Tone(1.0, 0.1, 0.01))


def make_result(
    system: str = "test_rig", t_end: float = 0.2, record_step: float = 20e-6, **info: object
) -> Result:
    """A result with every output of a shipped system, with known means and amplitudes.

    Args:
        system: name of a shipped system.
        t_end, record_step: [s].
        info: fields of `RunInfo` that differ.
    """
    structure = read_system(system)
    time = np.arange(round(t_end / record_step) + 1) * record_step
    tones = _tones()
    columns, units = {"time": time}, {"time": "s"}
    for part in structure.parts:
        for variable in COMPONENTS[part.component].declaration.variables:
            if variable.causality is Causality.OUTPUT:
                name = f"{part.name}.{variable.name}"
                columns[name] = _tone(tones, part.name, variable.name)(time)
                units[name] = variable.unit
    gear, housing = structure.part("gear_mesh").name, structure.part("modal_housing").name
    fields = {
        "system": system,
        "scene": "loaded",
        "model": {part.name: part.component for part in structure.parts},
        "t_end": t_end,
        "communication_step": record_step,
        "record_step": record_step,
        "micro_steps": {gear: 2.5e-6},
        "algorithm": "gs",
        "fmu": "in-process",
        "macro_steps": time.size - 1,
        "passes": {part.name: time.size - 1 for part in structure.parts},
        "rollbacks": 0,
        "wall_s": 0.5,
        "anatomy": anatomy(structure),
        "parameters": {f"{gear}.pinion.number_of_teeth": 27.0},
        "sensors": structure.sensors,
        "resources": {f"{housing}.{name}": f"{name}.csv" for name in ("modes", "shapes")},
    } | info
    outcome = Outcome(OutcomeKind.COMPLETED, t_end)
    return Result(pd.DataFrame(columns), units, outcome, RunInfo(**fields), structure.channels)


def make_foreign_result() -> Result:
    """A result of a system that knows nothing of gears: two units, no channel groups."""
    time = np.linspace(0.0, 1.0, 501)
    data = pd.DataFrame(
        {"time": time, "ball.h": np.abs(np.cos(5.0 * time)), "ball.v": -np.sin(5.0 * time),
         "other.level": time**2}
    )  # fmt: skip
    info = RunInfo(
        "ball", "", {"ball": "BouncingBall.fmu", "other": "Tank.fmu"}, 1.0, 2e-3, 2e-3, {},
        "jacobi", "python", 500, {"ball": 500, "other": 500}, 0, 0.01,
    )  # fmt: skip
    units = {"time": "s", "ball.h": "m", "ball.v": "m/s", "other.level": ""}
    return Result(data, units, Outcome(OutcomeKind.COMPLETED, 1.0), info)

"""The test rig in-process: scenes, the twin's answer, and errors against it."""

from dataclasses import replace
from functools import cache

import numpy as np

from herringbone.analysis.accuracy.error import relative_error
from herringbone.analysis.twin.monolithic import Twin
from herringbone.components.ports import HALVES
from herringbone.cosim.structure.system_file import find_system, read_system
from herringbone.running.start import started
from herringbone.scenes import find_scene, read_scene
from support.parts.running import columns, run_in_process

PINION_TORQUE = 200.0
SPEED = 1000.0 * np.pi / 30.0
BASE_RADIUS = 50.298e-3  # of the pinion; separation.toml
BEARING_Y = [f"gearbox.bearing_supports.shaft.{half}.f_y" for half in HALVES]
BEARING = [*BEARING_Y, *(f"gearbox.bearing_supports.shaft.{half}.f_z" for half in HALVES)]
SEAT = [f"gearbox.modal_housing.{half}.v_{axis}" for half in HALVES for axis in "xyz"]
MESH = [f"gearbox.gear_mesh.mesh_{side}.force" for side in ("left", "right")]
SPEEDS = ["gearbox.gear_mesh.pinion.w", "gearbox.gear_mesh.wheel.w"]
TORQUES = ["drive_coupling.torque", "load_coupling.torque"]


def scene(name):
    return read_scene(find_scene(find_system("test_rig"), name))


@cache
def rig(name="loaded", start=None):
    chosen = scene(name)
    return started(read_system("test_rig"), replace(chosen, start=start or chosen.start))[0]


@cache
def twin(name, t_end, step=20e-6):
    """Times and a table by column of the twin's bearing forces, seat velocities, ..."""
    times = np.arange(round(t_end / step) + 1) * step
    names = [*BEARING, *SEAT, *MESH, *SPEEDS, *TORQUES]
    values = Twin(rig(name)).solve(times, names)
    return times, dict(zip(names, values.T, strict=True))


def select(table, names):
    return np.column_stack([table[name] for name in names])


def errors(algorithm, steps, name="loaded"):
    """Errors of bearing forces and seat velocities over the first 20 ms."""
    _, table = twin(name, 0.02)
    found = []
    for h in steps:
        recording = run_in_process(rig(name), algorithm, h, 0.02, record=20e-6)
        assert recording.outcome.reached_end
        found.append(
            [
                relative_error(columns(recording, names), select(table, names))
                for names in (BEARING, SEAT)
            ]
        )
    return np.array(found)

"""The test rig in one of its scenes beside its twin, whose answer is solved once."""

from dataclasses import replace

import numpy as np
import pytest

from herringbone.analysis.accuracy.error import relative_error
from herringbone.analysis.twin.monolithic import Twin
from herringbone.components.ports import HALVES
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.system_file import find_system, read_system
from herringbone.running.start import started
from herringbone.scenes import find_scene, read_scene
from support.parts.running import columns, open_in_process

FINE = 10e-6
"""Grid of the twin [s]; all steps are whole numbers of it."""
BEARING = [f"gearbox.bearing_supports.shaft.{half}.f_{axis}" for half in HALVES for axis in "yz"]
SEAT = [f"gearbox.modal_housing.{half}.v_{axis}" for half in HALVES for axis in "xyz"]


def rig(name, **values):
    """The rig at the start of a scene, with some values of it changed."""
    scene = read_scene(find_scene(find_system("test_rig"), name))
    scene = replace(scene, values={**scene.values, **values})
    return started(read_system("test_rig"), scene)[0]


class BesideTwin:
    """A scene, run up to t_end [s], and its twin's answer."""

    def __init__(self, name, t_end, **values):
        self.system, self.t_end = rig(name, **values), t_end
        times = np.arange(round(t_end / FINE) + 1) * FINE
        self._twin = Twin(self.system).solve(times, [*BEARING, *SEAT])

    def run(self, algorithm, h, parts=None):
        """Errors of bearing forces and seat velocities, and the recording.

        The parts are those of this package in this process, if none are given.
        """
        parts = open_in_process(self.system) if parts is None else parts
        recording = simulate(self.system, parts, algorithm, make_grid(self.t_end, h, h))
        assert recording.outcome.completed
        assert recording.step == pytest.approx(h, rel=1e-12)
        twin = self._twin[:: round(h / FINE)]
        error = [
            relative_error(columns(recording, BEARING), twin[:, : len(BEARING)]),
            relative_error(columns(recording, SEAT), twin[:, len(BEARING) :]),
        ]
        return np.array(error), recording

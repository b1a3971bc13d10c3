"""The communication step that an exported system gets for masters that step in parallel."""

import numpy as np
import pytest

from herringbone.analysis.stability.steps.step_limits import step_limits
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.running.exporting.parallel_step import PARALLEL, UNKNOWN, parallel_step
from herringbone.running.prepared import Wishes, prepared


@pytest.mark.parametrize(("name", "factor"), [("test_rig", 1.0), ("e_axle", 1.0), ("gearbox", 4.0)])
def test_a_third_of_the_limit(name, factor):
    """Rounded to one digit: at most half as much again, and at least two thirds."""
    pinion = "bearing_supports.pinion.radial_stiffness"
    system = prepared(name, None, Wishes(values={pinion: factor * 6.34e8}))[0]
    ratio = parallel_step(system) / step_limits(system, PARALLEL).limit
    assert 2.0 / 9.0 <= ratio <= 0.5


def test_what_is_not_known_is_told(tmp_path, caplog):
    foreign = PartSpec("motor", fmu=tmp_path / "motor.fmu")
    assert parallel_step(System("one", "", (foreign,), ())) == UNKNOWN
    assert "is not known" in caplog.text
    assert np.isfinite(parallel_step(System("two", "", (PartSpec("a", "rotating_inertia"),), ())))

"""Radiated power of a steady state: the same as of a run that has settled; what it refuses."""

import pytest

import herringbone as hb
from herringbone.analysis.steady.report import steady_summary, steady_text
from herringbone.core import ParameterError


@pytest.fixture(scope="module")
def state():
    """The rig at 1000 r/min, 200 N m."""
    return hb.steady("test_rig")


def test_lines_and_a_run_radiate_alike(state):
    found = hb.radiated_power(state)
    run = hb.run("test_rig", fuse=True, t_end=0.4, record=["bearing_supports.seat.*"])
    # Power goes with the square of forces, of which both err by 1e-3 and splines by 1e-3 more.
    assert found.total == pytest.approx(hb.radiated_power(run).total, rel=6e-3)
    loudest = found.frequency_hz[found.power.argmax()]
    assert loudest == pytest.approx(3 * 27 * 1000 / 60, rel=1e-6)  # the third mesh order
    assert found.frequency_hz[-1] <= found.highest_hz == 2000.0


def test_one_line_of_two(state):
    run = hb.radiated_power(state)
    assert repr(run) == f"RadiatedPower(level {run.told})"
    assert f"  {run.told}" in steady_text(state)
    told = steady_summary(state)["radiated_power_dB"]
    assert told == {"gearbox.modal_housing": run.level_db}


def test_what_is_no_motion_is_told(state):
    with pytest.raises(ParameterError, match="'modal_housin' is not a housing"):
        hb.radiated_power(state, part="modal_housin")
    with pytest.raises(ParameterError, match="is of a run's result or a steady state"):
        hb.radiated_power("results")
    with pytest.raises(ParameterError, match="no part is known as housing"):
        hb.radiated_power(hb.steady("on_ground"))

"""Pictures of run-ups: units, orders, what is cut; and that steady runs have none."""

import math
from dataclasses import replace

import numpy as np
import pytest
from support.result import make_result

from herringbone.analysis.figures.runup import rotation, tracked
from herringbone.core import ParameterError
from herringbone.plotting.runs.pictures import write_pictures
from herringbone.plotting.runs.runup import run_up
from herringbone.plotting.runs.spectra import spectra

FORCE = "gearbox.bearing_supports.shaft.pinion_left.f_y"
SPEED = "gearbox.gear_mesh.pinion.w"


@pytest.fixture(scope="module")
def runup():
    """From 500 to 2000 r/min in 0.4 s; the force has 5 N of the mesh order 1 and 1 N of order 3."""
    result = make_result(t_end=0.4)
    time = result.data["time"].to_numpy()
    speed = (500.0 + 1500.0 * time / 0.4) * np.pi / 30.0
    cycles = 27.0 * (500.0 * time + 0.5 * 1500.0 * time**2 / 0.4) / 60.0
    force = 100.0 + sum(a * np.sin(2 * np.pi * k * cycles) for k, a in ((1, 5.0), (3, 1.0)))
    return replace(result, data=result.data.assign(**{SPEED: speed, FORCE: force}))


def test_mesh_orders_of_a_run(runup):
    """Speed is linear in time, so that its integral by trapezoids is exact."""
    found = tracked(runup, FORCE)
    assert found.cut(1.0) == pytest.approx(5.0, rel=1e-4)
    assert found.cut(3.0) == pytest.approx(1.0, rel=1e-3)
    ends = 27.0 * np.array([500.0, 2000.0]) / 60.0
    assert ends[0] < found.speed[0] < 1.3 * ends[0]
    assert 0.9 * ends[1] < found.speed[-1] < ends[1]


def test_a_reversal_ends_what_turns_in_one_direction(runup):
    """From +100 to -200 rad/s: the longer part is the one backwards; its amplitude is even."""
    time = runup.data["time"].to_numpy()
    speed = 100.0 - 750.0 * time
    cycles = 27.0 * (100.0 * time - 375.0 * time**2) / (2.0 * np.pi)
    force = 3.0 * np.sin(2.0 * np.pi * cycles + 1.0)
    turned = replace(runup, data=runup.data.assign(**{SPEED: speed, FORCE: force}))
    found = rotation(turned)
    assert found.time[0] == pytest.approx(100.0 / 750.0, abs=2.0 * (time[1] - time[0]))
    assert found.time[-1] == time[-1]
    assert (np.diff(found.speed) > 0.0).all()
    assert tracked(turned, FORCE).cut(1.0) == pytest.approx(3.0, rel=1e-3)


def test_ends_of_pictures(runup):
    with pytest.raises(ParameterError, match=r"^highest=nan: it must be positive, in Hz$"):
        run_up(runup, highest=math.nan)
    with pytest.raises(ParameterError, match=r"^order=inf: it must be positive and finite$"):
        run_up(runup, order=math.inf)
    with pytest.raises(ParameterError, match=r"^highest=-1: it must be positive, in Hz$"):
        spectra(runup, -1.0)


def test_picture_has_a_row_per_column_with_units(runup):
    figure = run_up(runup, "*.f_y")
    bars = [a for a in figure.axes if a.get_ylabel().startswith("dB re ")]
    maps = [a for a in figure.axes if a.get_ylabel().startswith("frequency, cut at ")]
    cuts = [a for a in figure.axes if a.get_ylabel().startswith("amplitude of orders [")]
    assert len(bars) == len(maps) == len(cuts) == len(runup.columns("*.f_y"))
    assert maps[-1].get_xlabel() == cuts[-1].get_xlabel() == "pinion speed [r/min]"
    labels = [line.get_label() for line in cuts[0].lines]
    assert labels == ["rms of all", "$f_m$", *(f"${order} f_m$" for order in range(2, 7))]
    assert "of 25000 [Hz]" in maps[0].get_ylabel()


def test_waterfall_goes_to_what_is_asked(runup):
    axes = run_up(runup, FORCE, highest=2000.0).axes[0]
    assert axes.get_ylim()[1] == pytest.approx(2000.0, rel=0.02)


def test_steady_runs_have_no_such_picture(tmp_path):
    with pytest.raises(ParameterError, match="no change of speed"):
        run_up(make_result())
    files = write_pictures(make_result(t_end=0.05), tmp_path)
    assert "run_up.png" not in {file.name for file in files}


def test_run_ups_have_it_in_their_report(runup, tmp_path):
    assert "run_up.png" in {file.name for file in write_pictures(runup, tmp_path)}

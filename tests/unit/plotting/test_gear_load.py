"""Picture of a loaded pair: what its panels hold, where the halves lie."""

import math

import numpy as np
import pytest
from matplotlib.collections import QuadMesh
from support.gearing.gears import SPUR, THESIS, gear_pair

from herringbone.gears.job import GearJob
from herringbone.gears.load.figures import Conditions, loaded_figures
from herringbone.gears.load.loaded_pair import Symmetry
from herringbone.gears.stiffness.slices import SliceMesh
from herringbone.plotting.gears.gear_load import gear_load_picture
from herringbone.plotting.gears.gear_pair import gear_pair_picture


def draw(data: dict, **conditions: object) -> tuple:
    job = GearJob(gear_pair(data), torque=200.0)
    mesh = SliceMesh(job.pair, slices=60)
    loaded = loaded_figures(job, mesh, mesh.solve(job.task().loads, 64), Conditions(**conditions))
    return loaded, gear_load_picture(loaded, "Pair").axes


def test_halves_side_by_side():
    """Left half from its outer end at 69.8 mm to the gap, right half on; one scale of pressure."""
    loaded, axes = draw(THESIS, symmetry=Symmetry(10e-6, 1e8))
    left, right = axes[0], axes[1]
    assert left.get_title("left").startswith("Contact pressure left, at most ")
    assert left.get_xlim() == pytest.approx((69.3, 23.0), abs=0.1)
    assert right.get_xlim() == pytest.approx((-23.0, -69.3), abs=0.1)
    maps = [next(c for c in a.collections if isinstance(c, QuadMesh)) for a in (left, right)]
    assert maps[0].get_clim() == maps[1].get_clim()
    for map_, flank in zip(maps, loaded.flanks, strict=True):
        assert map_.get_array().max() == pytest.approx(1e-6 * flank.pressure.max())
    assert maps[0].get_array().mean() > 1.3 * maps[1].get_array().mean()


def test_curves():
    """Transmission error about its mean over two periods, over torque, and k_L above k_R."""
    loaded, axes = draw(THESIS, symmetry=Symmetry(10e-6, 1e8))
    panels = {panel.get_title("left"): panel for panel in axes}
    error = panels["Transmission error about its mean"]
    own = next(line for line in error.lines if line.get_label() == "200 N m")
    assert np.ptp(own.get_ydata()) == pytest.approx(1e6 * loaded.pair.peak_to_peak)
    assert own.get_xdata().size == 128
    over = panels["Transmission error, peak to peak"].lines[0]
    assert over.get_xdata() == pytest.approx([pair.torque for pair in loaded.torques])
    left, right = panels["Secant stiffness"].lines
    assert left.get_label() == f"left, {100.0 * loaded.pair.share_left:.1f} % of the load"
    assert left.get_ydata().mean() > right.get_ydata().mean()


def test_single_half():
    loaded, axes = draw(SPUR, speed=200.0 * math.pi / 30.0)
    titles = [panel.get_title("left") for panel in axes]
    largest = 1e-6 * loaded.flanks[0].largest_pressure
    assert titles[0] == f"Contact pressure, at most {largest:.0f} MPa at a point"
    assert "MPa, means over strips of the flank" in {panel.get_ylabel() for panel in axes}
    assert len(loaded.flanks) == 1
    assert not any("left" in title for title in titles)


def test_legend_of_stiffness_curves_says_what_its_forces_are():
    mesh = SliceMesh(gear_pair(THESIS), slices=20)
    panel = gear_pair_picture(mesh.solve(GearJob(mesh.pair).task().loads, 16), "Pair").axes[-1]
    assert panel.get_legend().get_title().get_text() == "normal force"
    assert all(line.get_label().endswith(" N") for line in panel.lines)

"""Teeth that deviate, by the law of one pair of teeth, against the load distribution over all gaps.

Issue 13: over a wheel turn, classes 4 to 8, 50 to 400 N m, every line of the transmission error
above 1 % of the largest within 10 %, smaller ones within 0.1 % of the largest. Mesh harmonics 1 to
4 and side bands of both shafts are such lines; deviations have an equal part in all halves of a
pair, so that one half shows it.
"""

import numpy as np
import pytest
from support.gearing.deviating_teeth import PAIR, deflections, write_law, write_teeth
from support.gearing.gear_mesh import gear_pair

from herringbone.components.gear_mesh import layout as at
from herringbone.components.gear_mesh.teeth import toothed
from herringbone.gears import Modification
from herringbone.gears.accuracy.deviations import deviations
from herringbone.gears.files.table_file import write_table
from herringbone.gears.job import GearJob
from herringbone.gears.stiffness.coupled_slices import CoupledSliceMesh
from herringbone.gears.stiffness.deviating_teeth import DeviatingTeeth
from herringbone.gears.stiffness.slices import SliceMesh
from herringbone.kernels import force_law

WHEEL = 81
MESHES = {
    "slices": lambda: SliceMesh(PAIR, slices=60),
    "relieved slices": lambda: SliceMesh(PAIR, Modification(tip_relief=(20e-6, 20e-6)), slices=60),
    "coupled slices": lambda: CoupledSliceMesh(PAIR),
}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Mesh, its stiffness table and its law of one pair of teeth, by name."""
    made = {}

    def of(name):
        if name not in made:
            folder, mesh = tmp_path_factory.mktemp("law"), MESHES[name]()
            loads = GearJob(PAIR, torque=200.0).task().loads
            write_table(mesh.solve(loads, 256).resampled(64), folder / "table.csv")
            made[name] = mesh, folder / "table.csv", write_law(folder / "law.csv", mesh)
        return made[name]

    return of


def parameters(law, teeth):
    return {"pair_law": str(law), "tooth_deviations": str(teeth)}


def lines(curve, per_period):
    """Amplitudes of all lines over a wheel turn, from the first to below the fifth harmonic."""
    return np.abs(np.fft.rfft(curve))[1 : min(5, per_period // 2) * WHEEL]


def check(files, folder, name, grade, torque, per_period):
    mesh, table, law = files(name)
    gear = gear_pair(table, parameters(law, write_teeth(folder / "teeth.csv", grade)))
    phases, force = np.arange(WHEEL * per_period) / per_period, PAIR.tooth_forces(torque).normal
    teeth = DeviatingTeeth(mesh, deviations(PAIR, grade, 7))
    wanted = lines(teeth.deflections(phases, force), per_period)
    error = np.abs(lines(deflections(gear, phases, force), per_period) - wanted)
    large = wanted > 0.01 * wanted.max()
    assert large.sum() > 25  # both shafts, side bands and mesh harmonics
    assert (error[large] / wanted[large]).max() < 0.1
    assert error[~large].max() < 1e-3 * wanted.max()


@pytest.mark.parametrize("torque", [50.0, 200.0, 400.0])
@pytest.mark.parametrize("grade", [4, 5, 6, 7, 8])
def test_lines_of_the_transmission_error(files, tmp_path, grade, torque):
    check(files, tmp_path, "slices", grade, torque, 16)


@pytest.mark.parametrize(
    ("name", "grade", "torque"),
    [("relieved slices", 4, 400.0), ("relieved slices", 8, 50.0), ("coupled slices", 6, 200.0)],
)
def test_reliefs_and_slices_that_support_each_other(files, tmp_path, name, grade, torque):
    check(files, tmp_path, name, grade, torque, 8 if name == "coupled slices" else 16)


def test_without_deviations_the_sum_is_the_stiffness_table(files, tmp_path):
    """What is between is the interpolation over 48 nodes of a mesh period."""
    _, table, law = files("coupled slices")
    gear = gear_pair(table, parameters(law, write_teeth(tmp_path / "teeth.csv", 6)))
    phases, depth = np.arange(128) / 128, 2.4e-6
    found = np.array([toothed(gear.block, 0, 0, p, depth, 0.0)[:2] for p in phases])
    wanted = np.array([force_law.law(gear.block, at.TABLE[0], p, depth)[:2] for p in phases])
    np.testing.assert_allclose(found, wanted, rtol=3e-3)
    ours, theirs = (np.abs(np.fft.rfft(force))[1:5] for force in (found[:, 0], wanted[:, 0]))
    np.testing.assert_allclose(ours, theirs, rtol=0.015)


def test_flank_load_of_teeth_that_deviate(files):
    """Forces of the points make up the load; with ideal teeth they are those of the mesh."""
    mesh, *_ = files("coupled slices")
    force, ideal = 2000.0, [_scaled(teeth, 0.0) for teeth in deviations(PAIR, 6, 7)]
    line = DeviatingTeeth(mesh, deviations(PAIR, 6, 7)).line_load(5.3, force)
    assert np.sum(line.load * line.length) == pytest.approx(force, rel=1e-9)
    same = DeviatingTeeth(mesh, ideal).line_load(5.3, force)
    np.testing.assert_allclose(same.load, mesh.line_load(0.3, force).load, rtol=1e-6, atol=1e-3)
    assert line.load.max() > 1.5 * same.load.max()


def _scaled(teeth, factor):
    return type(teeth)(*(factor * value for value in vars(teeth).values()))

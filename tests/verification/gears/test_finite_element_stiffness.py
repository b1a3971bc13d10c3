"""Mesh stiffness by finite elements: convergence, slices against it, and its calibration factor."""

from dataclasses import replace

import numpy as np
import pytest
from support.gearing.gears import DRAWN_STEEP, DRAWN_WIDE, HELICAL, SPUR, THESIS, gear_pair

from herringbone.core import ParameterError
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.gears.files.shipped_table import GEAR_FILE
from herringbone.gears.finite_elements import (
    Calibration,
    FiniteElementMesh,
    Resolution,
    calibrate,
    calibration,
    calibration_factor,
)
from herringbone.gears.finite_elements.convergence import difference, solved
from herringbone.gears.finite_elements.mesh import SLICES
from herringbone.gears.job import GearJob
from herringbone.gears.stiffness.calibration import full_torque
from herringbone.gears.stiffness.coupled_slices import CoupledSliceMesh
from herringbone.gears.stiffness.methods import mesh_stiffness
from herringbone.gears.stiffness.slices import PHASES, SliceMesh

pytest.importorskip("skfem", reason="scikit-fem (extra 'fe') is not installed")


def coarse(data: dict, torque: float, layers: int, model: type) -> Calibration:
    pair = gear_pair(data)
    mesh = FiniteElementMesh(pair, resolution=Resolution(5, 2, 1, layers))
    return calibrate(mesh, pair.tooth_forces(torque).normal, model)


def test_spur_slices_against_finite_elements():
    """Mean 3 %, first two mesh harmonics 15 %; the slice method's own factor, b 3.1 m_n."""
    found = coarse(SPUR, 200.0, 8, SliceMesh)
    assert found.slices.secant.mean() == pytest.approx(found.elements.secant.mean(), rel=1e-4)
    assert found.factor == pytest.approx(0.899, abs=0.01)
    np.testing.assert_allclose(found.harmonic_ratio[:2], 1.0, atol=0.05)


@pytest.fixture(scope="module")
def helical() -> dict[str, FiniteElementMesh]:
    return {
        name: FiniteElementMesh(gear_pair(data), resolution=Resolution(5, 2, 1, layers))
        for name, data, layers in (("thesis", THESIS, 16), ("helical", HELICAL, 20))
    }


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "torques"),
    [("thesis", (200.0, 1000.0, 2000.0)), ("helical", (2e4, 1e5))],
)
def test_loads_have_the_same_calibration(helical, name, torques):
    """Mean 3 % and first two mesh harmonics 15 % at every load, without a factor."""
    mesh = helical[name]
    loads = [mesh.pair.tooth_forces(torque).normal for torque in torques]
    elements = mesh.solve(loads)
    slices = CoupledSliceMesh(mesh.pair).solve(loads)
    np.testing.assert_allclose(slices.secant.mean(axis=1), elements.secant.mean(axis=1), rtol=0.03)
    ratio = slices.harmonics()[:, :2] / elements.harmonics()[:, :2]
    np.testing.assert_allclose(ratio, 1.0, atol=0.15)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("data", "layers"),
    [(SPUR, 8), (THESIS, 16), (HELICAL, 20), (DRAWN_WIDE, 18), (DRAWN_STEEP, 12)],
    ids=["spur", "thesis", "helical", "drawn wide", "drawn steep"],
)
def test_methods_with_their_own_calibration(data, layers):
    """Means within 3 %; harmonics 1 to 4 within what the tables state as their uncertainty.

    Of coupled slices: 15 % of the harmonic, or 0.03 % of the mean where that is more. No method was
    fitted to the drawn pairs.  The torque is that of 100 N/mm.
    """
    task = GearJob(gear_pair(data)).task()
    load = task.pair.tooth_forces(full_torque(task.pair)).normal
    task = replace(task, loads=[load])
    mesh = FiniteElementMesh(task.pair, resolution=Resolution(5, 2, 1, layers))
    elements = solved(mesh, [load])
    wanted, mean = elements.harmonics()[0, :4], elements.secant.mean()
    for method in ("slices", "coupled-slices"):
        found = mesh_stiffness(task, method)
        assert found.secant.mean() == pytest.approx(mean, rel=0.03), method
        error = np.abs(found.harmonics()[0, :4] - wanted)
        assert np.all(error <= found.uncertainty.harmonics[0]), method
    assert np.all(error <= np.maximum(0.15 * wanted, 3e-4))


@pytest.mark.slow
def test_plain_slices_miss_the_support_along_the_face(helical):
    """The reason for the coupled slices: harmonics of a wide helical gear, 10 deg."""
    mesh = helical["helical"]
    found = calibrate(mesh, mesh.pair.tooth_forces(2e4).normal)
    assert found.harmonic_ratio[0] > 1.15
    assert found.harmonic_ratio[1] < 0.5


@pytest.mark.slow
def test_stiffness_of_the_thesis_pair(helical):
    """2.011e9 N/m, the thesis' figure, is met within 2 % at 2000 N m, b 47.3 mm per half."""
    mesh = helical["thesis"]
    found = calibrate(mesh, mesh.pair.tooth_forces(2000.0).normal)
    assert 2.0 * found.elements.secant.mean() == pytest.approx(2.011e9, rel=0.02)
    assert found.factor == pytest.approx(0.880, abs=0.01)


@pytest.mark.slow
def test_convergence_of_the_mesh():
    """Default and coarse meshes against one with elements two thirds as large."""
    pair = gear_pair(SPUR)
    load = pair.tooth_forces(200.0).normal
    fine = FiniteElementMesh(pair, resolution=Resolution(12, 4, 3, 12)).solve([load])
    for resolution, mean, harmonic in (
        (Resolution(), 0.005, 0.005),
        (Resolution(5, 2, 1, 8), 0.01, 0.01),
    ):
        found = FiniteElementMesh(pair, resolution=resolution).solve([load])
        assert found.secant.mean() == pytest.approx(fine.secant.mean(), rel=mean)
        assert found.harmonics()[0, 0] == pytest.approx(fine.harmonics()[0, 0], rel=harmonic)


@pytest.mark.slow
def test_convergence_of_contact_and_phases():
    """The shipped table's: harmonics 1 to 4 within 3 %, those above the tenth within 0.02 %.

    Its mesh is in `python -m herringbone.gears.finite_elements.convergence`: too long for a test.
    """
    job = read_gear_file(GEAR_FILE)
    mesh = FiniteElementMesh(job.pair)
    load = job.pair.tooth_forces(job.pinion_torque).normal
    found = solved(mesh, [load])
    for finer, phases in ((mesh, 2 * PHASES), (replace(mesh, slices=2 * SLICES), PHASES)):
        error = np.abs(difference(found, solved(finer, [load], phases)))[0]
        assert error[0] < 1e-3
        assert np.all(error[1:5] < 0.03)
        assert error[5] < 2e-4


def test_teeth_coupled_by_the_body_are_softer():
    """Two pairs in contact bend the same body; a single pair does not know."""
    pair = gear_pair(SPUR)
    load = pair.tooth_forces(200.0).normal
    options = {"pair": pair, "resolution": Resolution(4, 2, 1, 4)}
    alone = FiniteElementMesh(**options).solve([load], 32)
    coupled = FiniteElementMesh(coupled_teeth=True, **options).solve([load], 32)
    single = alone.secant[0] < alone.secant[0].mean()
    np.testing.assert_allclose(coupled.secant[0, single], alone.secant[0, single], rtol=1e-3)
    assert np.all(coupled.secant[0, ~single] < 0.9 * alone.secant[0, ~single])


def test_factor_out_of_reach_is_refused():
    mesh = FiniteElementMesh(gear_pair(SPUR), resolution=Resolution(4, 2, 1, 4))
    for tooth in mesh.teeth:
        tooth.matrices[:] *= 40.0
    with pytest.raises(ParameterError, match=r"no calibration factor between 0.2 and 4"):
        calibrate(mesh, mesh.pair.tooth_forces(200.0).normal)


def test_factor_at_the_load_of_iso_6336(monkeypatch):
    """Without a load: 100 N/mm of tangential force per face width."""
    pair = gear_pair(SPUR)
    seen = []

    def record(mesh: FiniteElementMesh, load: float, model: type) -> Calibration:
        seen.append((load, model))
        return Calibration(1.0, None, None)

    monkeypatch.setattr(calibration, "calibrate", record)
    calibration_factor(pair)
    tangential = seen[0][0] * pair.base_radius[0] / pair.reference_radius[0]
    assert tangential == pytest.approx(1e5 * pair.face_width)

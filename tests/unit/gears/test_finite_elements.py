"""Finite elements of teeth: compliance, stiffness, contact; processes, cache and refusals."""

import builtins
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from support.gearing.gears import HELICAL, SPUR, THESIS, gear_pair

from herringbone.core import ParameterError
from herringbone.core.places.paths import CACHE_VARIABLE
from herringbone.gears.finite_elements import (
    FiniteElementMesh,
    Resolution,
    both_teeth,
    second_process,
)
from herringbone.gears.finite_elements.blocks import Profile
from herringbone.gears.finite_elements.compliance import UNKNOWNS, layer_count, tooth_mesh
from herringbone.gears.finite_elements.layer import layer_stiffness
from herringbone.gears.finite_elements.section import mesh_section
from herringbone.gears.finite_elements.unit_loads import sweep_lead, unit_loads
from herringbone.gears.stiffness.equilibrium import ContactPoints, balance
from herringbone.gears.stiffness.methods import Task, mesh_stiffness

pytest.importorskip("skfem", reason="scikit-fem (extra 'fe') is not installed")
YOUNG, POISSON = 2.06e11, 0.3
COARSE = Resolution(profile=4, thickness=2, root=1, layers=4)


@pytest.mark.parametrize("gear", [0, 1])
def test_loads_are_normal_to_the_flank(gear):
    """A screw motion along the helix leaves the flank in itself: the unit loads do no work."""
    pair = gear_pair(THESIS)
    section = tooth_mesh(pair, gear, COARSE)
    unknowns = np.arange(section.points[0].size * 3).reshape(-1, 3)
    path = np.linspace(0.0, pair.path_of_contact.length, 5)
    loads, _ = unit_loads(pair, gear, section, unknowns, path, 0)
    lead = sweep_lead(pair, gear)
    x, y = section.points
    screw = np.c_[lead * y, -lead * x, np.ones_like(x)].ravel()
    assert np.abs(screw @ loads).max() < 2e-4
    assert np.abs(np.c_[lead * y, -lead * x, 0.0 * x].ravel() @ loads).min() > 0.4


def test_default_layers_keep_to_the_limit():
    pair = gear_pair(HELICAL, face_width=1.0)
    section = tooth_mesh(pair, 1, Resolution())
    layers = layer_count(pair, Resolution(), section)
    layer = layer_stiffness(section, 1.0 / layers, 0.0, YOUNG, POISSON)
    unknowns = (layers + 1) * layer.size + layers * layer.inner
    assert UNKNOWNS - layer.size - layer.inner < unknowns <= UNKNOWNS


@pytest.fixture(scope="module")
def spur() -> FiniteElementMesh:
    return FiniteElementMesh(gear_pair(SPUR), resolution=COARSE)


def test_compliance_is_symmetric_and_positive(spur):
    for tooth in spur.teeth:
        matrix = tooth.matrices[0]
        values = np.linalg.eigvalsh(matrix)
        assert np.array_equal(matrix, matrix.T)
        assert values[0] > -1e-3 * values[-1]
        assert tooth.asymmetry < 0.1


def test_dimensions_scale_out(spur):
    """Twice the size, the same material: half the compliance; to rounding."""
    data = {**SPUR, "normal_module": 2 * SPUR["normal_module"]}
    data |= {name: 2 * SPUR[name] for name in ("face_width", "center_distance")}
    large = FiniteElementMesh(gear_pair(data), resolution=COARSE)
    for big, small in zip(large.teeth, spur.teeth, strict=True):
        np.testing.assert_allclose(2.0 * big.matrices, small.matrices, rtol=1e-6)


def test_stiffness_is_that_of_the_face_width(spur):
    """A wide spur gear: twice the face, twice the layers, twice the stiffness; ends 1 %."""
    wide = gear_pair(SPUR, face_width=2 * SPUR["face_width"])
    double = FiniteElementMesh(wide, resolution=replace(COARSE, layers=8))
    load = 1e4
    once = spur.solve([load], 8).secant.mean()
    assert double.solve([2 * load], 8).secant.mean() == pytest.approx(2.0 * once, rel=0.015)


def test_swapped_pair_has_the_same_stiffness():
    """Pinion and wheel change places: the mesh period runs backwards, nothing else."""
    names = ("number_of_teeth", "profile_shift_coefficient")
    turned = {name: SPUR[name][::-1] for name in names}
    meshes = [
        FiniteElementMesh(
            gear_pair(SPUR, center_distance=None, helix_angle=0.4, **change), resolution=COARSE
        )
        for change in ({}, turned)
    ]
    a, b = (mesh.solve([5e3], 16) for mesh in meshes)
    assert b.secant.mean() == pytest.approx(a.secant.mean(), rel=1e-3)
    np.testing.assert_allclose(b.harmonics()[0, :2], a.harmonics()[0, :2], rtol=2e-2)


def test_energy_is_the_work_of_the_load(spur):
    """Force over deflection, integrated up to a load, against the tangent's integral."""
    loads = np.geomspace(100.0, 5e3, 41)
    found = spur.solve(loads, 4)
    steps = np.diff(loads)[:, None] * 0.5 * (1 / found.tangent[1:] + 1 / found.tangent[:-1])
    np.testing.assert_allclose(steps.sum(axis=0), np.ptp(found.deflection, axis=0), rtol=1e-3)


def linear_points() -> ContactPoints:
    rng = np.random.default_rng(1)
    root = rng.normal(size=(12, 12))
    compliance = (root @ root.T + np.eye(12)) * 1e-9
    length = rng.uniform(0.5, 1.5, 12) * 1e-3
    constant = np.full(12, 1e-12)
    gap = rng.uniform(0.0, 2e-5, 12)
    return ContactPoints(compliance, length, gap, lambda load: (constant, constant))


@pytest.mark.parametrize("force", [1.0, 1e3, 1e5])
def test_contact_pushes_and_does_not_overlap(force):
    """Forces, separations and their products, as the contact conditions ask."""
    points = linear_points()
    found = balance(points, force)
    apart = (
        points.compliance @ found.forces
        + 1e-12 * found.forces / points.length
        + points.gap
        - found.deflection
    )
    assert found.forces.sum() == pytest.approx(force, rel=1e-9)
    assert found.forces.min() >= 0.0
    assert apart.min() > -1e-9 * found.deflection
    assert np.abs(apart * found.forces).max() < 1e-9 * force * found.deflection
    more = balance(points, force * (1 + 1e-6), found.forces)
    assert found.tangent == pytest.approx(1e-6 * force / (more.deflection - found.deflection), 1e-3)


@pytest.fixture
def cached(tmp_path, monkeypatch) -> Path:
    """Small meshes are computed like large ones: two processes, and an empty cache."""
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    monkeypatch.setattr(both_teeth, "_LARGE", 0.0)
    return tmp_path / "tooth_compliance"


def test_two_processes_give_the_same_teeth(spur, cached, monkeypatch):
    """To the last bit; the second time out of the cache; the share done rises to 1."""
    told: list[float] = []
    pair = gear_pair(SPUR)
    mesh = FiniteElementMesh(pair, resolution=COARSE, progress=lambda _, done: told.append(done))
    for one, other in zip(mesh.teeth, spur.teeth, strict=True):
        assert np.array_equal(one.matrices, other.matrices)
        assert np.array_equal(one.path, other.path)
        assert np.array_equal(one.face, other.face)
        assert (one.asymmetry, one.unknowns) == (other.asymmetry, other.unknowns)
    assert told == sorted(told)
    assert told[-1] == pytest.approx(1.0)
    assert len(list(cached.glob("*.npz"))) == 1
    monkeypatch.setattr(both_teeth, "tooth_compliance", lambda *_: pytest.fail("computed again"))
    again = FiniteElementMesh(pair, resolution=COARSE).teeth
    assert np.array_equal(again[1].matrices, spur.teeth[1].matrices)


def test_dead_process_is_replaced(spur, cached, monkeypatch):
    """The process ends at once: its tooth is computed here."""
    monkeypatch.setattr(second_process, "_MODULE", "herringbone.no_such_module")
    found = FiniteElementMesh(gear_pair(SPUR), resolution=COARSE).teeth
    assert np.array_equal(found[1].matrices, spur.teeth[1].matrices)


def test_process_ends_with_what_needs_it(cached):
    """An error beside it: nothing is left running."""
    other = second_process.SecondProcess((gear_pair(SPUR), 1, COARSE, 0))
    with pytest.raises(KeyboardInterrupt), other:
        raise KeyboardInterrupt
    assert other._process.returncode is not None


def test_finer_neighbours_and_ring():
    """`others` refines what is not the loaded tooth; the compliance hardly changes."""
    pair = gear_pair(SPUR)
    coarse, fine = (tooth_mesh(pair, 0, replace(COARSE, others=count)) for count in (1, 2))
    assert len(fine.nodes) > 1.5 * len(coarse.nodes)
    meshes = [FiniteElementMesh(pair, resolution=replace(COARSE, others=count)) for count in (1, 2)]
    means = [mesh.solve([5e3], 8).secant.mean() for mesh in meshes]
    assert means[1] == pytest.approx(means[0], rel=2e-3)


def test_thin_rim_is_refused_at_once():
    pair = gear_pair(SPUR, bore_diameter=(0.055, 0.030))
    with pytest.raises(ParameterError, match=r"rim of .* mm between bore .* smaller bore"):
        FiniteElementMesh(pair)


def test_sharp_root_is_refused_at_once():
    radial = np.array([np.linspace(4e-3, 3e-3, 50), np.linspace(30e-3, 38e-3, 50)])
    with pytest.raises(ParameterError, match="root fillet is too small to be meshed"):
        mesh_section(Profile(radial, 20, 15e-3), COARSE)


def test_counts_must_be_positive():
    with pytest.raises(ParameterError, match="layers = 0 elements must be at least 1"):
        Resolution(layers=0)


def test_missing_scikit_fem_names_the_extra(monkeypatch):
    real = builtins.__import__

    def without(name: str, *rest: object, **more: object) -> object:
        if name.partition(".")[0] == "skfem":
            raise ImportError("No module named 'skfem'")
        return real(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(ParameterError, match=r"scikit-fem.*pip install 'herringbone\[fe\]'"):
        mesh_stiffness(Task(gear_pair(SPUR), [0.0, 1e3]), "fe")

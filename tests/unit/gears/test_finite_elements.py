"""Finite elements of a tooth: section, layer, elimination, contact."""

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
from herringbone.gears.finite_elements.dissection import stack_compliance
from herringbone.gears.finite_elements.layer import Layer, layer_stiffness
from herringbone.gears.finite_elements.section import Section, mesh_section
from herringbone.gears.finite_elements.unit_loads import sweep_lead, unit_loads
from herringbone.gears.stiffness.equilibrium import ContactPoints, balance
from herringbone.gears.stiffness.methods import Task, mesh_stiffness

pytest.importorskip("skfem", reason="scikit-fem (extra 'fe') is not installed")
YOUNG, POISSON = 2.06e11, 0.3
COARSE = Resolution(profile=4, thickness=2, root=1, layers=4)


def free(section: Section) -> Section:
    return replace(section, bore=np.empty(0, dtype=int))


def condensed(layer: Layer) -> np.ndarray:
    """(2 n, 2 n) stiffness of a layer over the displacements of its two sections."""
    full = np.zeros((2 * layer.size + layer.inner,) * 2)
    for matrix, places in zip(layer.matrices, layer.places, strict=True):
        used = places >= 0
        full[np.ix_(places[used], places[used])] += matrix[np.ix_(used, used)]
    between = np.arange(layer.size, layer.stride)
    ends = np.setdiff1d(np.arange(len(full)), between)
    link = full[np.ix_(between, ends)]
    return full[np.ix_(ends, ends)] - link.T @ np.linalg.solve(full[np.ix_(between, between)], link)


def area(section: Section) -> float:
    """By Gauss points of the nine-node elements."""
    at, weight = np.polynomial.legendre.leggauss(3)
    at, weight = 0.5 * (at + 1.0), 0.5 * weight
    shape = np.array([(1 - at) * (1 - 2 * at), 4 * at * (1 - at), at * (2 * at - 1)])
    slope = np.array([4 * at - 3, 4 - 8 * at, 4 * at - 1])
    corners = section.points[:, section.nodes]
    along = np.einsum("xeij,ip,jq->xepq", corners, slope, shape)
    across = np.einsum("xeij,ip,jq->xepq", corners, shape, slope)
    jacobian = along[0] * across[1] - along[1] * across[0]
    return float(np.abs(np.einsum("epq,p,q->e", jacobian, weight, weight)).sum())


def bar(length: float, height: float, columns: int, rows: int) -> Section:
    """Rectangle along y, held at y = 0, loaded and measured nowhere in particular."""
    x = np.linspace(-0.5 * height, 0.5 * height, 2 * columns + 1)
    y = np.linspace(0.0, length, 2 * rows + 1)
    points = np.stack(np.meshgrid(x, y, indexing="ij")).reshape(2, -1)
    index = np.arange(points.shape[1]).reshape(x.size, y.size)
    nodes = np.lib.stride_tricks.sliding_window_view(index, (3, 3))[::2, ::2].reshape(-1, 3, 3)
    edges = nodes[:rows, 0, :]
    return Section(points, nodes, edges, {0: edges}, index[:, 0])


@pytest.mark.parametrize("data", [SPUR, THESIS], ids=["spur", "thesis"])
@pytest.mark.parametrize("gear", [0, 1])
def test_section_covers_ring_and_three_teeth(data, gear):
    """Quadratic arcs on the far side of the ring leave out 0.3 %."""
    pair = gear_pair(data)
    profile = pair.tooth_profile(gear, points=400)
    root, tip = profile.root_radius, profile.tip_radius
    x, y = profile.points.T
    side = 0.5 * np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])
    tip_angle, root_angle = profile.half_angle(tip), profile.root_half_angle
    tooth = 2.0 * abs(side) + tip_angle * tip**2 - root_angle * root**2
    ring = np.pi * (root**2 - pair.hub_radius[gear] ** 2)
    section = tooth_mesh(pair, gear, Resolution())
    assert area(section) == pytest.approx(ring + 3.0 * tooth, rel=0.004)
    x, y = section.points[:, section.flank]
    radius = np.hypot(x, y)
    on_involute = radius > profile.form_radius
    wanted = [profile.half_angle(r) for r in radius[on_involute]]
    assert on_involute.sum() > 10
    np.testing.assert_allclose(np.arctan2(x, y)[on_involute], wanted, atol=1e-6)


@pytest.mark.parametrize("left", [1, 3])
def test_section_has_no_cracks(left):
    """Vertices - edges + faces of a ring: 0; a node that was not merged would change it."""
    pair = gear_pair(THESIS)
    profile = Profile(pair.tooth_profile(0).points.T, 27, pair.hub_radius[0])
    corners = mesh_section(profile, Resolution(), left, 1).nodes[:, ::2, ::2]
    around = corners.reshape(-1, 4)[:, [0, 1, 3, 2]]
    edges = np.sort(np.stack([around, np.roll(around, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    assert np.unique(corners).size - len(np.unique(edges, axis=0)) + len(corners) == 0


@pytest.mark.parametrize("data", [SPUR, HELICAL, THESIS], ids=["spur", "helical", "thesis"])
def test_layer_has_no_force_under_rigid_motion(data):
    """Held nowhere; a rotation is exact to the geometry's order of the curved elements."""
    pair = gear_pair(data)
    section = free(tooth_mesh(pair, 0, COARSE))
    twist = 0.002 if data is not SPUR else 0.0
    layer = layer_stiffness(section, 0.5 * pair.normal_module, twist, YOUNG, POISSON)
    x, y = np.delete(section.points, np.flatnonzero(layer.unknowns[:, 0] < 0), axis=1)
    full = condensed(layer)
    zero, one, turn = np.zeros_like(x), np.ones_like(x), twist * np.ones_like(x)
    along_axis = np.r_[np.c_[zero, zero, one].ravel(), np.c_[zero, zero, one].ravel()]
    sideways = np.r_[
        np.c_[one, zero, zero].ravel(), np.c_[np.cos(turn), np.sin(turn), zero].ravel()
    ]
    spin = np.tile(np.c_[y, -x, zero].ravel(), 2) / np.hypot(x, y).max()
    for motion, exact in ((along_axis, 1e-12), (sideways, 1e-12), (spin, 1e-5)):
        assert np.abs(full @ motion).max() < exact * np.abs(full).max()
    assert np.abs(full - full.T).max() < 1e-12 * np.abs(full).max()


def test_patch_of_uniaxial_stress():
    """A gear slice stretched along its axis, free to contract: force E A strain."""
    pair = gear_pair(SPUR)
    section = free(tooth_mesh(pair, 0, COARSE))
    thickness, strain = 2e-3, 1e-3
    layer = layer_stiffness(section, thickness, 0.0, YOUNG, POISSON)
    x, y = np.delete(section.points, np.flatnonzero(layer.unknowns[:, 0] < 0), axis=1)
    lower = np.c_[-POISSON * strain * x, -POISSON * strain * y, 0.0 * x].ravel()
    upper = np.c_[-POISSON * strain * x, -POISSON * strain * y, strain * thickness + 0.0 * x]
    force = (condensed(layer) @ np.r_[lower, upper.ravel()])[layer.size :]
    scale = YOUNG * strain * area(section)
    assert force[2::3].sum() == pytest.approx(scale, rel=1e-9)
    assert np.abs(force.reshape(-1, 3)[:, :2]).max() < 1e-9 * scale


def test_cantilever():
    """Tip deflection of a Timoshenko beam, Poisson's ratio zero: P L^3 / 3EI + 6 P L / 5GA."""
    length, height, width, layers = 0.1, 0.01, 0.008, 2
    section = bar(length, height, 2, 12)
    layer = layer_stiffness(section, width / layers, 0.0, YOUNG, 0.0)
    tip = np.flatnonzero(np.isclose(section.points[1], length) & np.isclose(section.points[0], 0.0))
    load = np.zeros((layer.size, 1))
    load[layer.unknowns[tip[0], 0], 0] = 1.0 / (layers + 1)
    found = stack_compliance(layer, layers, load, load).sum()
    inertia, shear = width * height**3 / 12.0, 0.5 * YOUNG * height * width
    beam = length**3 / (3.0 * YOUNG * inertia) + 1.2 * length / shear
    assert found == pytest.approx(beam, rel=2e-3)


@pytest.mark.parametrize("layers", [1, 3, 9])
def test_elimination_against_a_direct_solution(layers):
    """One layer is cut between elements alone, nine along the face first."""
    section = bar(0.03, 0.01, 2, 3)
    layer = layer_stiffness(section, 2e-3, 0.01, YOUNG, POISSON)
    n, sections = layer.size, layers + 1
    rng = np.random.default_rng(3)
    loads, measures = rng.normal(size=(n, 2)), rng.normal(size=(n, 3))
    full = np.zeros((sections * n, sections * n))
    block = condensed(layer)
    for k in range(layers):
        here = slice(k * n, (k + 2) * n)
        full[here, here] += block
    each = np.eye(sections)
    direct = np.kron(each, measures).T @ np.linalg.solve(full, np.kron(each, loads))
    found = stack_compliance(layer, layers, loads, measures).reshape(direct.shape)
    assert np.abs(found - direct).max() < 1e-10 * np.abs(direct).max()


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

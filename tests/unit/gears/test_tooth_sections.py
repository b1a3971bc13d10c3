"""Section, layer and elimination of a tooth's finite elements."""

from dataclasses import replace

import numpy as np
import pytest
from support.gearing.gears import HELICAL, SPUR, THESIS, gear_pair

from herringbone.gears.finite_elements import Resolution
from herringbone.gears.finite_elements.blocks import Profile
from herringbone.gears.finite_elements.compliance import tooth_mesh
from herringbone.gears.finite_elements.dissection import stack_compliance
from herringbone.gears.finite_elements.layer import Layer, layer_stiffness
from herringbone.gears.finite_elements.section import Section, mesh_section

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

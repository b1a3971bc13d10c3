"""Closed forms for the finite elements: beams, a plate, a stretched bar, rigid bodies."""

import numpy as np
import pytest

from herringbone.housing.eigenmodes import eigenmodes
from herringbone.housing.welded.design import Material
from herringbone.housing.welded.mesher import Mesh

skfem = pytest.importorskip("skfem", reason="scikit-fem is optional (extra fe)")
from herringbone.housing.welded.elasticity import Solid  # noqa: E402 (needs scikit-fem)

STEEL = Material(young_modulus=210e9, poisson_ratio=0.3, density=7850.0)
E, RHO = STEEL.young_modulus, STEEL.density
SHEAR_FACTOR = 5 / 6
E_OVER_KG = 2 * (1 + STEEL.poisson_ratio) / SHEAR_FACTOR


def block(lengths: tuple[float, ...], cells: tuple[int, ...]) -> Solid:
    """A block with one corner at the origin."""
    grid = [np.linspace(0.0, a, n + 1) for a, n in zip(lengths, cells, strict=True)]
    mesh = skfem.MeshTet.init_tensor(*grid)
    return Solid(Mesh(mesh.p.T, mesh.t.T), STEEL)


def facets_at(solid: Solid, axis: int, value: float) -> np.ndarray:
    facets = solid.boundary()
    return facets[np.isclose(solid.corners(facets)[..., axis], value).all(axis=1)]


def clamped(solid: Solid, facets: np.ndarray) -> np.ndarray:
    """Free unknowns when facets are held."""
    count = len(solid.nodes)
    free = np.setdiff1d(np.arange(count), solid.nodes_on(facets))
    return np.concatenate([axis * count + free for axis in range(3)])


def beam_shape(root: float, sigma: float, sign: int) -> np.ndarray:
    """Mean squares of Euler-Bernoulli's mode shape and its derivatives 1 to 3 over root**k."""
    x = root * np.linspace(0.0, 1.0, 4001)
    even, odd = (np.cosh(x), sign * np.cos(x)), (np.sinh(x), sign * np.sin(x))
    w = [
        even[0] + even[1] - sigma * (odd[0] + odd[1]),
        odd[0] - odd[1] - sigma * (even[0] + even[1]),
        even[0] - even[1] - sigma * (odd[0] - odd[1]),
        odd[0] + odd[1] - sigma * (even[0] - even[1]),
    ]
    return np.square(w).mean(axis=1)


def beam_frequency(root: float, sigma: float, sign: int, height: float) -> float:
    """Euler-Bernoulli frequency with rotary inertia and shear to first order [Hz].

    Rayleigh's quotient: rotary inertia adds r**2 int w'**2 to int w**2, shear adds the share
    (E / k G) r**2 int w'''**2 / int w''**2 to the flexibility.
    """
    radius = height / np.sqrt(12) / LENGTH
    w, slope, curvature, third = beam_shape(root, sigma, sign)
    corrections = (root * radius) ** 2 * (slope / w + E_OVER_KG * third / curvature)
    square = (root / LENGTH) ** 4 * E * (radius * LENGTH) ** 2 / RHO
    return np.sqrt(square / (1 + corrections)) / (2 * np.pi)


LENGTH, WIDTH, HEIGHT = 1.0, 0.03, 0.02
# Roots and factors: R. D. Blevins, Formulas for natural frequency and mode shape, table 8-1.
FREE = [(4.73004074, 0.982502215), (7.85320462, 1.000777312)]
CLAMPED = [(1.87510407, 0.734095514), (4.69409113, 1.018467319)]


def beam_frequencies(roots: list[tuple[float, float]], sign: int) -> np.ndarray:
    heights = (WIDTH, HEIGHT)
    return np.sort([beam_frequency(*root, sign, height) for root in roots for height in heights])


def test_free_beam():
    """Six rigid motions at 0 Hz, then bending in both planes."""
    solid = block((LENGTH, WIDTH, HEIGHT), (40, 2, 2))
    modes = eigenmodes(solid.stiffness(), solid.mass(), 10, shift=-1e5)
    assert modes.frequency_hz[:6].max() < 1e-2  # rounding of eigenvalues of 1e15 / s**2
    # The mesh raises it, by some (element / wave length)**4; second order of shear lowers: 1e-5.
    error = modes.frequency_hz[6:] / beam_frequencies(FREE, 1) - 1
    assert error.min() > -2e-4
    assert error.max() < 1e-3


def test_clamped_beam():
    """Clamping hinders the lateral contraction: a tenth of a height becomes stiff."""
    solid = block((LENGTH, WIDTH, HEIGHT), (40, 2, 2))
    free = clamped(solid, facets_at(solid, 0, 0.0))
    modes = eigenmodes(solid.stiffness()[free][:, free], solid.mass()[free][:, free], 4)
    error = modes.frequency_hz / beam_frequencies(CLAMPED, -1) - 1
    assert error.min() > -2e-4
    assert error.max() < 4e-3


def plate_errors(cells: int) -> np.ndarray:
    """Of the first three frequencies of a clamped square plate, against Kirchhoff's theory.

    f = k / (2 pi a**2) sqrt(D / rho h); A. W. Leissa, Vibration of plates, NASA SP-160, 4.1.1.
    """
    side, thickness = 1.0, 0.02
    solid = block((side, side, thickness), (cells, cells, 1))
    rim = np.concatenate([facets_at(solid, axis, at) for axis in (0, 1) for at in (0.0, side)])
    free = clamped(solid, rim)
    modes = eigenmodes(solid.stiffness()[free][:, free], solid.mass()[free][:, free], 3)
    bending = E * thickness**3 / (12 * (1 - STEEL.poisson_ratio**2))
    scale = np.sqrt(bending / (RHO * thickness)) / (2 * np.pi * side**2)
    return modes.frequency_hz / (scale * np.array([35.992, 73.413, 73.413])) - 1


def test_clamped_plate():
    """Rotary inertia and shear lower by 0.5 to 1 % (h / a = 0.02); a mesh only raises."""
    coarse, fine = plate_errors(10), plate_errors(20)
    assert fine.min() > -0.01
    assert fine.max() < 0.015  # elements of 2.5 thicknesses
    assert (coarse > fine).all()


def test_stretched_bar():
    """A uniform traction stretches a bar by F x / (E A) and contracts it: exact (patch test)."""
    a, b, c = 0.2, 0.05, 0.03
    solid = block((a, b, c), (3, 2, 2))
    end = facets_at(solid, 0, a)
    x, y, z = solid.nodes.T
    strain = 1.0 / (E * b * c)
    u = strain * np.concatenate([x, -0.3 * y, -0.3 * z])
    load = np.kron(
        [1.0, 0.0, 0.0], solid.mean_weights(end) - solid.mean_weights(facets_at(solid, 0, 0.0))
    )
    scale = np.abs(load).max()
    np.testing.assert_allclose(solid.stiffness() @ u, load, atol=1e-11 * scale)
    assert solid.area(end) == pytest.approx(b * c, rel=1e-13)


def rigid_motions(solid: Solid, center: np.ndarray) -> np.ndarray:
    """Translations and rotations (3 n, 6)."""
    r = solid.nodes - center
    columns = [np.tile(e, (len(r), 1)) for e in np.eye(3)] + [np.cross(e, r) for e in np.eye(3)]
    return np.array([c.T.ravel() for c in columns]).T


def test_rigid_body():
    """Mass and moments of inertia of a block; no strain energy."""
    sides = np.array([0.4, 0.3, 0.2])
    solid = block(tuple(sides), (2, 2, 2))
    motions = rigid_motions(solid, sides / 2)
    mass = RHO * sides.prod()
    inertia = mass / 12 * ((sides**2).sum() - sides**2)
    np.testing.assert_allclose(
        motions.T @ (solid.mass() @ motions), np.diag([mass] * 3 + [*inertia]), atol=1e-12 * mass
    )
    assert RHO * solid.volume == pytest.approx(mass, rel=1e-13)
    energy = motions.T @ (solid.stiffness() @ motions)
    assert np.abs(energy).max() < 1e-12 * E


def test_quadratic_motion():
    """u_y = x**2 on a block: integrals of x**4 over its volume and over its two faces across y."""
    a, b, c = 0.4, 0.3, 0.2
    solid = block((a, b, c), (2, 2, 2))
    x, zero = solid.nodes[:, 0], np.zeros(len(solid.nodes))
    u = np.concatenate([zero, x**2, zero])
    assert u @ (solid.mass() @ u) == pytest.approx(RHO * a**5 / 5 * b * c, rel=1e-12)
    form = solid.normal_form(solid.boundary())
    assert u @ (form @ u) == pytest.approx(2 * a**5 / 5 * c, rel=1e-12)


def test_parts_add_up():
    solid = block((0.4, 0.3, 0.2), (2, 2, 2))
    elements = np.arange(solid.mesh.nelements)
    for whole in (solid.stiffness, solid.mass):
        parts = whole(elements[:7]) + whole(elements[7:])
        assert abs(parts - whole()).max() < 1e-13 * abs(whole()).max()


def test_surface_form():
    """Integral of squared normal motion: rigid and pulsating motions of a block, exact."""
    sides = np.array([0.4, 0.3, 0.2])
    a, b, c = sides
    solid = block(tuple(sides), (3, 2, 2))
    form = solid.normal_form(solid.boundary())
    motions = rigid_motions(solid, sides / 2)
    pulsating = (solid.nodes - sides / 2).T.ravel()
    area = 2 * sides.prod() / sides  # of the two faces across each axis
    # Rotation about x: normal motion z on the faces across y, and y on those across z.
    turned = [
        area[1] * c**2 / 12 + area[2] * b**2 / 12,
        area[0] * c**2 / 12 + area[2] * a**2 / 12,
        area[0] * b**2 / 12 + area[1] * a**2 / 12,
    ]
    np.testing.assert_allclose(
        motions.T @ (form @ motions), np.diag([*area, *turned]), atol=1e-13 * area.max()
    )
    breathing = (area * (sides / 2) ** 2).sum()
    assert pulsating @ (form @ pulsating) == pytest.approx(breathing, rel=1e-12)


def test_interpolation():
    """Quadratic fields are interpolated exactly."""
    solid = block((0.4, 0.3, 0.2), (2, 2, 2))
    points = np.array([[0.11, 0.17, 0.2], [0.33, 0.02, 0.19]])

    def field(p: np.ndarray) -> np.ndarray:
        x, y, z = p.T
        return np.concatenate([x * y, z**2 - x, 1 + 3 * y * z])

    found = solid.interpolation(points) @ field(solid.nodes)
    np.testing.assert_allclose(found, field(points), atol=1e-13)

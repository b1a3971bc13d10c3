"""Force law of a mesh: F(., 0) = 0, periodic, C1, monotone, through its table; and its energy."""

from itertools import pairwise

import numpy as np
import pytest

from herringbone.components.resources.stiffness_table import read_stiffness_table
from herringbone.core.places.paths import component_folder
from herringbone.kernels import force_law

SHIPPED = component_folder("gear_mesh") / "resources" / "mesh_stiffness.csv"


def law(loads: np.ndarray, stiffness: np.ndarray, at: int = 7):
    """The law of stiffness[load, phase]: a function (phase, deflection) -> (F, tangent)."""
    block = np.full(at + force_law.TABLE_SIZE + 3, np.nan)
    scratch = np.empty(force_law.SCRATCH_SIZE)
    force_law.build(loads, stiffness.ravel().copy(), stiffness.shape[1], block, at, scratch)
    assert np.isnan(block[:at]).all()
    assert np.isnan(block[-3:]).all()
    assert np.isfinite(block[at:-3]).all()

    def function(phase: float, deflection: float) -> tuple[float, float]:
        return force_law.law(block, at, phase, deflection)[:2]

    function.block, function.at = block, at
    return function, block[at], block[at + 1]


def synthetic(phases: int) -> tuple[np.ndarray, np.ndarray]:
    """Loads and K = (1 + 5 % cos + 2 % sin) 1e9 load**0.1: Hertzian hardening, smooth in phase."""
    loads = np.geomspace(50.0, 5e4, 12)
    p = 2 * np.pi * np.arange(phases) / phases
    shape = 1 + 0.05 * np.cos(p) + 0.02 * np.sin(2 * p)
    return loads, 1e9 * shape * (loads[:, None] / 5e4) ** 0.1


TABLES = {
    "shipped": lambda: read_stiffness_table(SHIPPED)[0],
    "64 phases": lambda: synthetic(64),
    "20 phases": lambda: synthetic(20),
    "from zero load": lambda: (
        np.array([0.0, 100.0, 1e4]),
        np.full((3, 8), 1e9) * [[0.7], [0.8], [1]],
    ),
    "2 loads": lambda: (np.array([100.0, 1e4]), np.full((2, 8), 1e9) * [[0.8], [1.0]]),
}


@pytest.fixture(scope="module", params=TABLES)
def table(request):
    return TABLES[request.param]()


@pytest.fixture(scope="module")
def mesh(table):
    return law(*table)


POINTS = np.random.default_rng(3).uniform(size=(200, 2))


def test_no_force_without_deflection(mesh):
    force, _, _ = mesh
    assert all(force(p, 0.0)[0] == 0.0 for p in POINTS[:, 0])


def test_periodic(mesh):
    force, limit, _ = mesh
    for p, d in POINTS:
        here, there = force(p, d * limit), force(p + 3.0, d * limit)
        # Rounding of p + 3 is 4e-16 of a period; stiffness changes by less than 1 per period.
        np.testing.assert_allclose(there, here, rtol=1e-14)
    assert force(-0.25, 0.5 * limit) == force(0.75, 0.5 * limit)


def test_tangent_is_the_derivative_of_the_force(mesh):
    force, limit, _ = mesh
    for p, d in POINTS:
        x, e = 1.3 * limit * d, 1e-4 * limit * d
        slope = (force(p, x + e)[0] - force(p, x - e)[0]) / (2 * e)
        # Inside a cell the error is (e/x)**2 times an O(1) factor; a cell border, where the second
        # derivative jumps, inside the interval adds e/x: 1e-4.
        assert slope == pytest.approx(force(p, x)[1], rel=1e-4)


def test_continuous_across_the_borders_of_cells(mesh):
    force, limit, _ = mesh
    borders = (np.arange(1, force_law.DEFLECTIONS) / (force_law.DEFLECTIONS - 1)) ** 2 * limit
    for p in (0.0, 0.3):
        for x in borders:  # the last border is the limit
            below, above = np.array(force(p, x * (1 - 1e-9))), np.array(force(p, x * (1 + 1e-9)))
            # A C1 law changes by no more than 1e-9 times an O(1) factor.
            np.testing.assert_allclose(below, above, rtol=1e-7)
    for i in range(force_law.PHASES):
        p = i / force_law.PHASES
        below, above = (np.array(force(p + e, 0.2 * limit)) for e in (-1e-10, 1e-10))
        np.testing.assert_allclose(below, above, rtol=1e-8)


def test_c1_in_phase(mesh):
    """The one-sided slopes over phase agree at the borders of cells."""
    force, limit, _ = mesh
    e = 1e-5
    for i in range(force_law.PHASES):
        p, x = i / force_law.PHASES, 0.3 * limit
        left = (force(p, x)[0] - force(p - e, x)[0]) / e
        right = (force(p + e, x)[0] - force(p, x)[0]) / e
        # O(e) times the second derivative: where a line enters, 0.65 F per period over a 128th.
        assert abs(right - left) < e * 200 * force(p, x)[0]


def test_monotone(mesh):
    force, limit, _ = mesh
    for p in POINTS[:20, 0]:
        values = [force(p, x) for x in np.linspace(0.0, 1.5 * limit, 600)]
        assert min(tangent for _, tangent in values) > 0.0
        assert np.diff([f for f, _ in values]).min() > 0.0


def test_never_pulls_where_no_load_leaves_a_gap():
    """Relieved teeth: no stiffness under no load at some phases; a C2 spline swings below zero."""
    loads = np.array([0.0, 500.0, 2000.0, 8000.0])
    stiffness = np.full((4, 16), 4e8) * np.array([[0.5], [0.8], [0.9], [1.0]])
    stiffness[0, 4:8] = 0.0
    stiffness[0, 8:16:2] = 5e6
    force, limit, _ = law(loads, stiffness)
    for p in np.arange(512) / 512.0:
        for x in (1e-12, 1e-9, 1e-3 * limit, 0.01 * limit):
            assert force(p, x)[0] >= 0.0, (p, x)


def test_secant_is_constant_at_small_deflections(mesh):
    force, limit, smallest = mesh
    node = limit / (force_law.DEFLECTIONS - 1) ** 2  # below it there is one cell
    for p in POINTS[:20, 0]:
        if smallest < node:
            continue
        reference = force(p, 1e-3 * node)
        for x in np.array([1e-6, 0.1, 0.9]) * node:
            value, tangent = force(p, x)
            assert value / x == pytest.approx(reference[1], rel=1e-13)
            assert tangent == pytest.approx(reference[1], rel=1e-13)


def test_tangent_is_constant_above_the_limit(mesh):
    force, limit, _ = mesh
    for p in POINTS[:20, 0]:
        at_limit, tangent = force(p, limit)
        for factor in (1.001, 2.0, 10.0):
            value, slope = force(p, factor * limit)
            assert slope == pytest.approx(tangent, rel=1e-13)
            assert value == pytest.approx(at_limit + tangent * (factor - 1) * limit, rel=1e-12)


def energy(force, phase: float, x: float) -> float:
    return force_law.energy(force.block, force.at, phase, x)


def test_energy_is_the_integral_of_the_force(mesh):
    """Gauss' rule over u = sqrt(x), cell by cell: F dx is a polynomial of degree 6 in u there."""
    force, limit, _ = mesh
    points, weights = np.polynomial.legendre.leggauss(4)
    for p, d in POINTS[:40]:
        x = 1.5 * limit * d
        inside = np.sqrt(min(x, limit) / limit) * (force_law.DEFLECTIONS - 1)
        ends = np.append(np.arange(np.ceil(inside)), inside)
        total = 0.0
        for a, b in pairwise(ends):
            u = 0.5 * (a + b) + 0.5 * (b - a) * points
            size = limit / (force_law.DEFLECTIONS - 1) ** 2
            values = [force(p, v * v * size)[0] * 2 * v * size for v in u]
            total += 0.5 * (b - a) * float(weights @ values)
        if x > limit:
            total += (x - limit) * 0.5 * (force(p, limit)[0] + force(p, x)[0])
        assert energy(force, p, x) == pytest.approx(total, rel=1e-13)


def test_phase_slope_of_the_energy(mesh):
    force, limit, _ = mesh
    e = 1e-4
    for p, d in POINTS:
        x = 1.5 * limit * d
        p = (np.floor(p * 128) + 0.5) / 128  # noqa: PLW2901 (inside a cell)
        slope = (energy(force, p + e, x) - energy(force, p - e, x)) / (2 * e)
        found = force_law.law(force.block, force.at, p, x)[2]
        # A cubic in p: the difference is exact but for e**2 times its third derivative, at most
        # 6 * 128**3 of the differences of K between nodes, here below 2e-3 of K; and rounding.
        size = energy(force, p, x)
        assert found == pytest.approx(slope, abs=size * (e**2 * 128**3 * 2e-3 + 1e-12 / e))


def test_energy_of_a_table_without_phase_has_no_slope():
    loads, stiffness = np.array([100.0, 1e4]), np.full((2, 8), 1e9) * [[0.8], [1.0]]
    force, limit, _ = law(loads, stiffness)
    for p, d in POINTS[:20]:
        slope = force_law.law(force.block, force.at, p, 1.5 * limit * d)[2]
        assert abs(slope) <= 1e-12 * energy(force, p, 1.5 * limit * d)


def worst(loads: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    """Largest relative error of the force at the points of a table, by load."""
    force, _, _ = law(loads, stiffness)
    phases = stiffness.shape[1]
    return np.array(
        [
            max(abs(force(j / phases, load / k)[0] / load - 1) for j, k in enumerate(row))
            for load, row in zip(loads, stiffness, strict=True)
            if load > 0.0
        ]
    )


def test_reproduces_the_shipped_table():
    error = worst(*read_stiffness_table(SHIPPED)[0])
    # 33 nodes over sqrt(deflection): the two lowest loads (5 and 20 N m) share the second cell.
    assert error.max() < 1.1e-3
    assert error[2:-1].max() < 1e-4  # 50 N m and more
    # The largest load lies above the limit at all phases but one, by up to 7 % of the deflection,
    # over which the tangent changes by 0.4 %: half of their product.
    assert error[-1] < 2e-4


def test_reproduces_a_constant_table_to_rounding():
    assert worst(np.array([10.0, 1e5]), np.full((2, 8), 1e9)).max() < 1e-14


def test_limits_of_the_table(table, mesh):
    loads, stiffness = table
    _, limit, smallest = mesh
    assert limit == pytest.approx(min(loads[-1] / stiffness[-1]), rel=1e-15)
    assert smallest == pytest.approx(max(loads[0] / stiffness[0]), rel=1e-15)


def test_secant_leaves_its_limit_at_zero_load_with_the_deflection():
    """K - K(0) is of the order of the deflection, so that F has a second derivative there."""
    force, limit, _ = law(*TABLES["from zero load"]())
    small = np.array([1e-7, 1e-6]) * limit
    rise = [force(0.3, x)[0] / x - 0.7e9 for x in small]
    assert rise[1] / rise[0] == pytest.approx(10.0, rel=0.02)


def test_inside():
    block = np.full(3 + force_law.TABLE_SIZE, np.nan)
    block[3], block[4] = 5e-5, 1e-7
    cases = {-1.0: True, 0.0: True, 0.9e-7: False, 1.1e-7: True, 4.9e-5: True, 5.1e-5: False}
    assert {d: force_law.inside(block, 3, d) for d in cases} == cases


def test_phase_shape_between_the_points_of_the_table():
    """64 points resolve the fourth harmonic; the cubic's error is (2 pi 4/64)**4 / 384 of it."""
    loads, stiffness = np.array([10.0, 1e5]), np.empty((2, 64))
    stiffness[:] = 1e9 * (1 + 0.05 * np.cos(8 * np.pi * np.arange(64) / 64))
    force, limit, _ = law(loads, stiffness)
    for p in POINTS[:, 0]:
        expected = 1e9 * (1 + 0.05 * np.cos(8 * np.pi * p))
        bound = 2 * 0.05 * (2 * np.pi * 4 / 64) ** 4 / 384
        assert force(p, 0.5 * limit)[0] / (0.5 * limit) == pytest.approx(expected, rel=2 * bound)


@pytest.mark.parametrize("phase", [-9.2234e18, -1e19, 1e19, 1e300, np.inf, np.nan])
def test_a_phase_that_has_diverged_reads_inside_the_table(mesh, phase):
    """Beyond 2**63 the floor of a phase is undefined; the force is that of some phase."""
    force, _, _ = mesh
    inside = [force(p, 2e-6)[0] for p in np.linspace(0.0, 1.0, 65)]
    assert min(inside) <= force(phase, 2e-6)[0] <= max(inside)

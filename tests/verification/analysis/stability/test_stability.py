"""Predicted stability limits against theory, and what the prediction is made of."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from support.housing import PROTOTYPE_HOUSING

from herringbone.analysis.stability import atlas
from herringbone.analysis.stability.amplification import Amplification
from herringbone.analysis.stability.growth import GROWTH, Growth
from herringbone.analysis.stability.limits import default_algorithms
from herringbone.analysis.stability.linear_parts import MeshStiffness, linear_network
from herringbone.analysis.stability.steps import step_map
from herringbone.analysis.stability.steps.step_limits import step_limits
from herringbone.analysis.stability.steps.step_map import MappedPart, linear_part
from herringbone.analysis.stability.steps.step_scan import unstable_bands
from herringbone.cosim.algorithms import LI, Jacobi
from herringbone.cosim.algorithms.prepared import PreparedRun
from herringbone.cosim.loops.calls import do_step
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.cosim.structure.system_file import find_system, read_system
from herringbone.running.start import started
from herringbone.scenes import find_scene, read_scene

INERTIA = (0.01, 0.03)
COUPLING_FREQUENCY = 3000.0

RANGES = {
    Jacobi(0): (12e-6, 30e-6),
    Jacobi(1): (25e-6, 50e-6),
    Jacobi(2): (30e-6, 55e-6),
    LI(3): (540e-6, 720e-6),
}
"""Where the limits are looked for, so that the tests are short."""
PUBLISHED = {
    Jacobi(0): (15e-6, 20e-6),
    Jacobi(1): (37e-6, 41e-6),
    Jacobi(2): (42.8e-6, 44.2e-6),
    LI(3): (540e-6, 720e-6),
}
"""Limits of a dense prototype of the same gearbox, closed and open mesh, rounded outwards."""


@cache
def rig(housing=()):
    scene = read_scene(find_scene(find_system("test_rig"), "loaded"))
    scene = replace(scene, values={**scene.values, **dict(housing)})
    return started(read_system("test_rig"), scene)[0]


@cache
def predicted(algorithm):
    system = rig(tuple(PROTOTYPE_HOUSING.items()))
    amplification = Amplification(*linear_network(system), algorithm)
    return unstable_bands(amplification.growth, *RANGES[algorithm])[0][0]


@pytest.mark.slow
@pytest.mark.parametrize("algorithm", PUBLISHED, ids=str)
def test_limits_are_those_of_the_prototype(algorithm):
    low, high = PUBLISHED[algorithm]
    assert low < predicted(algorithm) < high


def two_rotors(zeta):
    """Two free rotors and a coupling: the two-mass problem, of a known local frequency."""
    reduced = INERTIA[0] * INERTIA[1] / sum(INERTIA)
    coupling = {
        "stiffness": reduced * COUPLING_FREQUENCY**2,
        "damping": 2.0 * zeta * reduced * COUPLING_FREQUENCY,
    }
    rotors = [
        PartSpec(name, component="load_motor", values={"inertia": inertia})
        for name, inertia in zip(("left", "right"), INERTIA, strict=True)
    ]
    return System(
        "two_rotors",
        "",
        (*rotors, PartSpec("coupling", component="shaft_coupling", values=coupling)),
        (("left.flange", "coupling.flange_a"), ("right.flange", "coupling.flange_b")),
    )


@pytest.mark.parametrize("zeta", [0.01, 0.05])
def test_two_rotors_against_the_analytic_limit(zeta):
    """Jacobi with held forces: h w < 4 zeta, in the limit of small zeta."""
    limit = step_limits(two_rotors(zeta), Jacobi(0)).limit
    assert limit * COUPLING_FREQUENCY == pytest.approx(4.0 * zeta, rel=0.01)


def test_parallel_schedule_costs_two_thirds_of_the_limit():
    zeta = 0.02
    limit = step_limits(two_rotors(zeta), Jacobi(0, "parallel")).limit
    assert limit * COUPLING_FREQUENCY == pytest.approx(4.0 / 3.0 * zeta, rel=0.02)


def test_quadratic_extrapolation_hardly_depends_on_damping():
    """Two-mass limits 0.95 undamped to 1.10 at 10 % (spectral radius of exact subsystems)."""
    for zeta, expected in ((0.005, 0.95), (0.1, 1.10)):
        limit = step_limits(two_rotors(zeta), Jacobi(2)).limit
        assert limit * COUPLING_FREQUENCY == pytest.approx(expected, abs=0.05)


def test_measured_matrix_leaves_the_parts_as_they_were():
    network, instances = linear_network(rig())
    before = [i.block.copy() for i in instances]
    amplification = Amplification(network, instances, LI(2))
    first = amplification.matrix(1e-4)
    mutable = [i.component.declaration.mutable_size for i in instances]
    for instance, block, size in zip(instances, before, mutable, strict=True):
        assert np.array_equal(instance.block[:size], block[:size])
    assert np.array_equal(amplification.matrix(1e-4), first)


def test_map_is_affine():
    """Differences twenty times larger give the same matrix, in units of the differences."""
    amplification = Amplification(*linear_network(rig()), Jacobi(2))
    small = amplification.matrix(2e-5)
    scale = amplification._steps.z_changes[amplification._used]
    amplification._steps.changes = 20.0 * amplification._steps.changes
    deviation = (amplification.matrix(2e-5) - small) * scale[None, :] / scale[:, None]
    assert np.abs(deviation).max() < 1e-7


@pytest.mark.parametrize("degree", [0, 3])
def test_mapped_step_is_the_part_s_own_step(degree):
    """Far away from where the map was measured, to the rounding of its differences."""
    _, instances = linear_network(rig())
    gear = next(i for i in instances if i.name == "gearbox.gear_mesh")
    part, random = MappedPart(gear), np.random.default_rng(0)
    part.prepare(1e-4, degree)
    size, outputs = part.values.size, part._results(degree)
    found = []
    for scale in (0.0, 100.0):
        values = part._operating_point.copy()
        entries, changes = part._entries(degree)
        values[entries] += scale * np.multiply(changes, random.standard_normal(len(entries)))
        part.values[:] = gear.block[:size] = values
        addresses = part.addresses
        assert do_step(addresses.do_step, addresses.component, 0.0, 1e-4) == 0
        assert gear.step(0.0, 1e-4) == 0
        found.append((part.values[outputs].copy(), gear.block[outputs].copy()))
    (mapped_base, base), (mapped, own) = found
    assert np.array_equal(mapped_base, base)
    moved = np.abs(own - base)
    assert (np.abs(mapped - own) <= 1e-6 * moved + 1e-12 * np.abs(own)).all()
    assert moved.max() > 0.0


@pytest.mark.parametrize("degree", [0, 3])
def test_a_composed_map_that_a_trial_contradicts_is_not_taken(monkeypatch, degree):
    """One thousandth off: then all columns are differences of the part's own steps."""
    _, instances = linear_network(rig())
    gear = next(i for i in instances if i.name == "gearbox.gear_mesh")
    part, composed, asked = MappedPart(gear), step_map.composed, []

    def wrong(*given):
        asked.append(given)
        return 1.001 * composed(*given)

    monkeypatch.setattr(step_map, "composed", wrong)
    part.prepare(1e-4, degree)
    base = part._advanced(1e-4, part._results(degree))
    assert np.array_equal(part._columns(1e-4, degree, base), part._measured(1e-4, degree))
    assert len(asked) == 2


@pytest.mark.parametrize("algorithm", default_algorithms(), ids=str)
def test_columns_of_one_call_are_those_of_runs(monkeypatch, algorithm):
    """To rounding: an iterated algorithm keeps its scale from run to run."""
    amplification = Amplification(*linear_network(atlas.two_rotors(0.02, 3.0)), algorithm)
    found = amplification.matrix(1e-4)
    run_from = type(amplification._steps._laid_out).run_from
    monkeypatch.setattr(type(amplification._steps._laid_out), "run_from", PreparedRun.run_from)
    assert found.size > 0
    assert amplification.matrix(1e-4) == pytest.approx(found, rel=1e-12, abs=1e-14)
    assert run_from is not PreparedRun.run_from


def test_the_step_of_a_mapped_part_is_not_compiled(monkeypatch):
    """Half a second for the gear mesh, in every first run."""
    asked = []
    monkeypatch.setattr("herringbone.components.in_process._do_step_address", asked.append)
    _, instances = linear_network(rig())
    for instance in instances:
        assert linear_part(instance).addresses.can_restore
    mapped = {"gear_mesh", "drive_motor", "load_motor"}
    assert set(asked) == {i.component.name for i in instances} - mapped


def test_stiffer_mesh_has_a_higher_tangent():
    tangents = []
    for stiffness in MeshStiffness:
        _, instances = linear_network(rig(), stiffness)
        gear = next(i for i in instances if i.name == "gearbox.gear_mesh")
        kernels, start = gear.component.kernels, gear["mesh_left.force"]
        gear.set("approach", gear["approach"] + 1e-8)
        kernels.out(gear.block, 0.0)
        tangents.append((gear["mesh_left.force"] - start) / 1e-8)
    assert tangents[0] < tangents[1] < tangents[2]


def grows_by(radius):
    """Growth of a known spectral radius, all of it fast."""
    return lambda step: Growth(radius(step), 0.0, radius(step))


def test_bands_of_a_known_radius():
    """An unstable island below the last limit is found, and its edges to 0.5 %."""

    def radius(step):
        bad = 20e-6 < step < 24e-6 or step > 31e-6
        return 1.1 if bad else 1.0 + 0.5 * GROWTH

    bands = unstable_bands(grows_by(radius))
    assert np.ravel(bands)[:3] == pytest.approx([20e-6, 24e-6, 31e-6], rel=0.006)
    assert bands[-1][1] == np.inf


@pytest.mark.parametrize("centre", [20e-6, 20.17e-6, 20.3e-6])
def test_band_narrower_than_the_scan(centre):
    """A resonance 0.8 % wide, between the steps of a scan by 2.5 %, wherever it lies."""

    def radius(step):
        resonance = 0.03 / (1.0 + ((step / centre - 1.0) / 0.006) ** 2)
        return max(0.98 + resonance, step / 31e-6)

    half = 0.006 * np.sqrt(0.03 / 0.02 - 1.0)
    bands = unstable_bands(grows_by(radius))
    assert len(bands) == 2
    assert bands[0] == pytest.approx((centre * (1.0 - half), centre * (1.0 + half)), rel=0.006)
    assert bands[1][0] == pytest.approx(31e-6, rel=0.006)


@pytest.mark.parametrize("start", [20e-6, 20.13e-6, 20.3e-6])
def test_narrow_band_close_to_the_first_unstable_step(start):
    """0.8 % wide, between the steps of a scan by 2.5 %, and nothing rises towards it."""
    edges = start * np.array([1.0, 1.026, 1.034, 1.042, 1.06])

    def radius(step):
        return 1.01 if np.searchsorted(edges, step) % 2 else 0.5

    found = np.ravel(unstable_bands(grows_by(radius)))
    assert found[:4] == pytest.approx(edges[:4], rel=0.006)


@pytest.mark.parametrize("zeta", [0.02, 0.1])
def test_simulated_points_of_the_atlas_lie_on_its_lines(zeta):
    """The limit of the real loop, by bisection, without any amplification matrix."""
    system = atlas.two_rotors(zeta, 3.0)
    bands = step_limits(system, Jacobi(1)).unstable_bands
    assert atlas.simulated_limit(system, Jacobi(1), bands) == pytest.approx(bands[0][0], rel=0.02)


def test_frozen_mesh_is_a_line_below_no_force():
    """A foreign part may push far from equilibrium in the steps of which a matrix is made.

    Forces of both meshes over the approach: equal differences down to the opposite of the load.
    """
    _, instances = linear_network(rig())
    gear = next(i for i in instances if i.name == "gearbox.gear_mesh")
    start, found = gear["approach"], []
    for way in range(9):
        gear.set("approach", start - way * 0.4e-6)
        gear.component.kernels.out(gear.block, 0.0)
        found.append([gear["mesh_left.force"], gear["mesh_right.force"]])
    falls = np.diff(found, axis=0)
    assert np.min(found) < 0.0
    assert falls == pytest.approx(np.broadcast_to(falls[0], falls.shape), rel=1e-6)

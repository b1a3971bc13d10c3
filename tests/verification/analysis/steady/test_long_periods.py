"""Steady states whose period is hundreds of meshes long, at few places that tell lines apart."""

import numpy as np
import pytest

from herringbone.analysis.steady.harmonic_balance import families
from herringbone.analysis.steady.harmonic_balance.correction import bent
from herringbone.analysis.steady.harmonic_balance.families import Families
from herringbone.analysis.steady.harmonic_balance.fourier import in_frequency, in_time, on
from herringbone.analysis.steady.harmonic_balance.krylov import correct_by_families
from herringbone.analysis.steady.harmonic_balance.orbit import Period
from herringbone.analysis.steady.operating_point import Point
from herringbone.analysis.steady.searching import guess, resolution
from herringbone.analysis.steady.state import SteadyState
from herringbone.running.operating.steady import prepared_solver
from herringbone.running.prepared import Wishes

TEETH = 23, 31
BASES = (23, 31, 713)
TOLERANCE = 1e-4
PAIR = """[gear_pair]
number_of_teeth = [23, 31]
normal_module = "4 mm"
helix_angle = "25 deg"
face_width = "40 mm"
gap_width = "40 mm"
stub_length = "60 mm"
shaft_diameter = ["45 mm", "45 mm"]
[mesh]
backlash = "120 um"
damping_ratio = 0.06
[table]
torque = "200 N m"
method = "coupled-slices"
phases = 16
"""


def thinned(sides: int) -> Period | None:
    return Period(16, 713 * 64, 713).thinned_to_lines(BASES, sides)


def test_few_places_tell_all_lines_apart():
    """What goes to time and back is the same, to rounding, whichever lines there are."""
    period = thinned(3)
    assert period is not None
    lines, chance = period.lines, np.random.default_rng(1)
    assert period.places < 713 * 64 / 10
    assert {0, 23, 31, 713, 713 - 31, 713 + 2 * 23 + 31, 31 * 713} <= set(lines.tolist())
    assert 713 + 4 * 23 not in lines
    values = chance.normal(size=(2, lines.size)) + 1j * chance.normal(size=(2, lines.size))
    values[:, 0] = values[:, 0].real
    found = in_frequency(in_time(values, lines, period.places), lines)
    np.testing.assert_allclose(found, values, atol=1e-12)


def test_lines_everywhere_need_all_places():
    assert thinned(40) is None


@pytest.fixture(scope="module")
def pair(tmp_path_factory):
    file = tmp_path_factory.mktemp("pair") / "pair.toml"
    file.write_text(PAIR, encoding="utf-8")
    return file


def solved(pair, tolerance: float) -> SteadyState:
    wishes = Wishes(values={"gear_mesh.symmetry_deviation": 200e-6}, gear=pair)
    return prepared_solver("gearbox", wishes=wishes, tolerance=tolerance)[0].solve()


def spectrum(state: SteadyState, orders: np.ndarray, group: str) -> np.ndarray:
    columns = state.channels[group]
    return on(orders, state.harmonics(columns).coefficients, state.numbers)[:, 1:]


@pytest.fixture(scope="module")
def whole(pair):
    """The state by all places."""
    with pytest.MonkeyPatch.context() as patch:
        for module in (guess, resolution):
            patch.setattr(module, "LONG", 10_000)
        return solved(pair, TOLERANCE / 10.0)


@pytest.mark.parametrize("sides", [1, 3])
def test_lines_alone_are_what_all_places_give(pair, whole, monkeypatch, sides):
    """Also if lines are at first looked for not far enough aside, as the error then tells."""
    monkeypatch.setattr(resolution, "SIDES", sides)
    ours = solved(pair, TOLERANCE)
    assert ours.converged
    assert whole.converged
    assert ours.meshes == whole.meshes == 713
    assert 10 * ours.orbit.places < whole.orbit.places
    assert ours.orbit.resolved.sides > 1
    orders = np.union1d(ours.numbers, whole.numbers)
    for group in ("bearing_force", "seat_velocity"):
        one, other = (spectrum(state, orders, group) for state in (ours, whole))
        assert np.linalg.norm(one - other) < 1.1 * TOLERANCE * np.linalg.norm(other)


def test_a_step_of_newton_is_the_same_with_families_of_low_orders(monkeypatch):
    """GMRES has the exact Jacobian, whose inverse beyond these orders is nearly 1."""
    solver, _ = prepared_solver("test_rig", point=Point(speed=100.0), tolerance=1e-3)
    state = solver.solve(Point(speed=100.0))
    structure, orbit = state.structure, state.orbit
    assert structure.meshes > 1
    steps, sizes = [], []
    for highest in (8, 1000):
        monkeypatch.setattr(families, "HIGHEST", highest)
        found = Families(orbit.response.orders, structure.meshes, orbit.resolved.order)
        own = found.inverses(orbit.response, bent(structure.problem, orbit.samples))
        sizes.append(own.shape[-1])
        off = np.zeros_like(orbit.channels[: structure.problem.values])
        off[:, 1:] = 1.0 / orbit.response.orders[1:]
        steps.append(
            correct_by_families(
                structure.problem, orbit.response, orbit.samples, off, found, TOLERANCE
            )
        )
    assert sizes[0] < 0.6 * sizes[1]
    size = np.linalg.norm(steps[1])
    assert np.linalg.norm(steps[0] - steps[1]) < 10.0 * TOLERANCE * size

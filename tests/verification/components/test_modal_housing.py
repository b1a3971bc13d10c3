"""Housing: exact for polynomial forces, static and dynamic closed forms, passivity."""

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.linalg import expm
from support.housing import read_modes

from herringbone.components.modal_housing import MODAL_HOUSING
from herringbone.components.modal_housing.layout import MODES, STEPS
from herringbone.components.ports import HALVES
from herringbone.core import Instance
from herringbone.core.places.paths import component_folder

DOFS = tuple((half, axis) for half in HALVES for axis in "xyz")
FORCES = [f"{half}.f_{axis}" for half, axis in DOFS]
RESOURCES = component_folder("modal_housing") / "resources"
FREQUENCY_HZ, DAMPING_RATIO, SHAPES = read_modes(
    RESOURCES / "modes.csv", RESOURCES / "shapes.csv", DOFS, MODES
)
OMEGA = 2 * np.pi * FREQUENCY_HZ


@pytest.fixture
def housing() -> Instance:
    instance = Instance(MODAL_HOUSING, "housing")
    instance.initialise()
    return instance


def motion(housing: Instance, quantity: str, node: str = "") -> np.ndarray:
    return np.array([housing[f"{half}.{quantity}_{axis}{node}"] for half, axis in DOFS])


def set_forces(
    housing: Instance, polynomials: list[Polynomial], degree: int, start: float, width: float
) -> None:
    """Force polynomials in the macro step's c, on the part [start, start + width] of it."""
    housing.set("interface_degree", degree)
    for name, polynomial in zip(FORCES, polynomials, strict=True):
        housing.set(name, float(polynomial(start)))
        for node in range(1, degree + 1):
            housing.set(f"{name}.node{node}", float(polynomial(start + width * node / degree)))


def random_forces(degree: int, seed: int = 0) -> list[Polynomial]:
    random = np.random.default_rng(seed)
    return [Polynomial(1e3 * random.standard_normal(degree + 1)) for _ in DOFS]


def random_start(housing: Instance) -> tuple[np.ndarray, np.ndarray]:
    """Modal coordinates and rates of comparable energy in all modes."""
    random = np.random.default_rng(7)
    q, v = random.standard_normal((2, OMEGA.size)) * np.stack(
        [1e-2 / OMEGA, np.full(OMEGA.size, 1e-2)]
    )
    housing.block[: OMEGA.size], housing.block[MODES : MODES + OMEGA.size] = q, v
    return q, v


def exact(q, v, polynomials: list[Polynomial], h: float, c: float) -> dict[str, np.ndarray]:
    """Seat motion at c h: matrix exponentials of each mode with a chain that makes the force."""
    coefficients = np.zeros((len(DOFS), 5))
    for row, polynomial in zip(coefficients, polynomials, strict=True):
        row[: polynomial.coef.size] = polynomial.coef
    factorial = np.array([1, 1, 2, 6, 24])
    ends = []
    for i, (w, zeta) in enumerate(zip(OMEGA, DAMPING_RATIO, strict=True)):
        modal_force = SHAPES[:, i] @ coefficients
        # In time units of h: the chain's state k is the k-th derivative of the force.
        a = np.zeros((7, 7))
        a[0, 1] = 1.0
        a[1, :3] = -((w * h) ** 2), -2 * zeta * w * h, h * h
        a[[2, 3, 4, 5], [3, 4, 5, 6]] = 1.0
        end = expm(a * c) @ np.concatenate([[q[i], v[i] * h], modal_force * factorial])
        acceleration = end[2] - w * (2 * zeta * end[1] / h + w * end[0])
        ends.append((end[0], end[1] / h, acceleration))
    return {name: SHAPES @ values for name, values in zip("sva", np.array(ends).T, strict=True)}


@pytest.mark.parametrize("degree", range(5))
@pytest.mark.parametrize("h", [1e-7, 1e-5, 1e-4, 1e-3])
def test_exact_for_polynomial_forces(housing, degree, h):
    q, v = random_start(housing)
    polynomials = random_forces(degree)
    set_forces(housing, polynomials, degree, 0.0, 1.0)
    assert housing.step(0.0, h) == 0
    scale = np.abs(SHAPES).max() ** 2 * 1e4  # N / kg
    for node in range(1, max(degree, 1) + 1):
        expected = exact(q, v, polynomials, h, node / max(degree, 1))
        for quantity in "sv":
            found = motion(housing, quantity, f".node{node}")
            # w h <= 44: 7 squarings lose 2**7 eps, in both computations; sums of 60 modes.
            np.testing.assert_allclose(
                found, expected[quantity], atol=1e-12 * 10 * np.abs(expected[quantity]).max()
            )
    for quantity in "sv":
        np.testing.assert_array_equal(
            motion(housing, quantity), motion(housing, quantity, f".node{max(degree, 1)}")
        )
    # Accelerations are differences of forces and w**2 q.
    np.testing.assert_allclose(motion(housing, "a"), expected["a"], atol=1e-11 * max(
        scale, np.abs(expected["a"]).max(), (OMEGA**2 * np.abs(q)).max()
    ))  # fmt: skip
    assert housing["pinion_left.f_x"] == polynomials[0](0.0)  # inputs are as set


@pytest.mark.parametrize("small", [100, 7])
def test_step_size_does_not_matter(small):
    """One step of 1 ms with forces of degree 4 equals many small ones with the same forces."""
    polynomials = random_forces(4, seed=1)
    ends = []
    for steps in (1, small):
        housing = Instance(MODAL_HOUSING, "housing")
        housing.initialise()
        random_start(housing)
        for n in range(steps):
            set_forces(housing, polynomials, 4, n / steps, 1 / steps)
            housing.step(n * 1e-3 / steps, 1e-3 / steps)
        ends.append(np.concatenate([motion(housing, "s"), motion(housing, "v") * 1e-4]))
    # Nodes of degree 4 in small steps have rounding eps, times its condition of 700.
    np.testing.assert_allclose(ends[1], ends[0], atol=1e-12 * np.abs(ends[0]).max())


def test_changing_the_step_changes_the_propagator(housing):
    q, v = random_start(housing)
    polynomials = [Polynomial([f]) for f in np.linspace(-1e3, 1e3, 12)]
    set_forces(housing, polynomials, 0, 0.0, 1.0)
    for h in (1e-4, 3e-5, 0.0, 1e-4, 0.0999999, 1e-16):
        assert housing.step(0.0, h) == 0
    expected = exact(q, v, polynomials, 0.1002299, 1.0)
    scale = np.abs(expected["v"]).max()
    # Phase of w t = 5000 in the highest mode: eps * 5000 in the sum of steps; 14 squarings.
    np.testing.assert_allclose(motion(housing, "v"), expected["v"], atol=1e-10 * scale)


def test_propagators_are_kept_and_found_again(housing):
    """More steps than are kept, in turn: each gives the same bits as in a housing that saw none."""
    forces, degree = random_forces(3), 3
    steps = 1e-6 * np.arange(1, STEPS + 4)
    for h in (*steps, *steps[::-1], *steps[::2]):
        fresh = Instance(MODAL_HOUSING, "fresh")
        fresh.initialise()
        fresh.block[:] = housing.block
        for instance in (housing, fresh):
            set_forces(instance, forces, degree, 0.0, 1.0)
            instance.step(0.0, h)
        assert np.array_equal(housing.block, fresh.block)


def test_a_first_step_of_no_length_changes_nothing(housing):
    q, v = random_start(housing)
    assert housing.step(0.0, 0.0) == 0
    np.testing.assert_array_equal(housing.block[: OMEGA.size], q)
    np.testing.assert_array_equal(housing.block[MODES : MODES + OMEGA.size], v)


def statics(force: np.ndarray) -> np.ndarray:
    return SHAPES @ ((SHAPES.T @ force) / OMEGA**2)


def at_rest_under(force: np.ndarray) -> Instance:
    housing = Instance(MODAL_HOUSING, "housing")
    for name, value in zip(FORCES, force, strict=True):
        housing.set(f"start.{name}", value)
        housing.set(name, value)
    housing.initialise()
    return housing


def test_start_forces_are_in_equilibrium():
    force = 1e3 * np.random.default_rng(2).standard_normal(12)
    housing = at_rest_under(force)
    s = statics(force)
    np.testing.assert_allclose(motion(housing, "s"), s, atol=1e-14 * np.abs(s).max())
    assert not motion(housing, "v").any()
    # Rounding of F - w**2 q.
    np.testing.assert_allclose(motion(housing, "a"), 0.0, atol=1e-13 * 1e3 * 12)
    for n in range(100):
        housing.step(n * 1e-4, 1e-4)
    np.testing.assert_allclose(motion(housing, "s"), s, atol=1e-12 * np.abs(s).max())


def test_static_reciprocity_and_stiffness():
    """The compliance at the seats is symmetric and positive definite."""
    compliance = np.array([motion(at_rest_under(e), "s") for e in np.eye(12)])
    np.testing.assert_allclose(compliance, compliance.T, atol=1e-14 * compliance.max())
    assert np.linalg.eigvalsh(compliance).min() > 0.0


def test_dynamic_reciprocity(housing):
    """A force record at i moves j as the same record at j moves i."""

    def response(at: int, seen: int) -> list[float]:
        instance = Instance(MODAL_HOUSING, "housing")
        instance.initialise()
        record = []
        for n in range(50):
            instance.set(FORCES[at], 1e3 * np.sin(0.3 * n) * (n < 20))
            instance.step(n * 1e-4, 1e-4)
            record.append(motion(instance, "s")[seen])
        return record

    first, second = response(1, 9), response(9, 1)
    np.testing.assert_allclose(first, second, atol=1e-13 * np.abs(first).max())


@pytest.mark.parametrize("seed", range(20))
def test_passivity(housing, seed):
    """From rest, forces never get out more work than they have put in."""
    random = np.random.default_rng(seed)
    h, boole = 1e-5, np.array([7, 32, 12, 32, 7]) / 90
    omega = 2 * np.pi * np.exp(random.uniform(np.log(50), np.log(6000), (12, 1)))
    amplitude, phase = 1e3 * random.standard_normal((12, 1)), random.uniform(0, 7, (12, 1))
    housing.set("interface_degree", 4)
    work, worked = 0.0, []
    for n in range(400):
        times = (n + np.arange(5) / 4) * h
        forces = amplitude * (np.sin(omega * times + phase) - np.sin(phase))
        velocities = [motion(housing, "v")]
        for name, values in zip(FORCES, forces, strict=True):
            for suffix, value in zip(
                ("", ".node1", ".node2", ".node3", ".node4"), values, strict=True
            ):
                housing.set(name + suffix, value)
        housing.step(n * h, h)
        velocities += [motion(housing, "v", f".node{node}") for node in (1, 2, 3, 4)]
        work += h * boole @ (forces.T * np.array(velocities)).sum(axis=1)
        worked.append(work)
    # Boole's rule: (w h / 4)**6 / 15 per step at 6 kHz: 5e-7 of the work that goes to and fro.
    assert min(worked) >= -1e-6 * max(worked)
    assert max(worked) > 0.0


def test_acceleration_depends_on_the_force_at_once(housing):
    """Direct feedthrough: a = sum of shape shape^T f; positions and velocities do not see it."""
    housing.set(FORCES[4], 1.0)
    housing.component.kernels.out(housing.block, 0.0)
    np.testing.assert_allclose(motion(housing, "a"), SHAPES @ SHAPES[4], rtol=1e-12, atol=1e-15)
    assert not motion(housing, "s").any()
    assert not motion(housing, "v").any()


def test_every_mode_has_a_nominal_value():
    """Rigid modes, and modes that do not move the seats, too: integrators divide by it."""
    housing = Instance(MODAL_HOUSING, "housing")
    housing.initialise()
    block, first = housing.block, MODAL_HOUSING.declaration.first_table + 1
    shapes = block[first + 2 * MODES :][: len(DOFS) * MODES].reshape(len(DOFS), MODES)
    before = MODAL_HOUSING.nominals(block).reshape(2, MODES)
    block[first] = 0.0
    shapes[:, 1] = 0.0
    after = MODAL_HOUSING.nominals(block).reshape(2, MODES)
    assert np.isfinite(after).all()
    assert (after > 0.0).all()
    rigid = 2.0 * np.pi * 10.0  # counts as 10 Hz
    np.testing.assert_allclose(after[:, 0], before[1, 0] * OMEGA[0] / [rigid**2, rigid])
    np.testing.assert_array_equal(after[:, 2:], before[:, 2:])

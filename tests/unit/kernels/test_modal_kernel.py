"""Propagator of an oscillator under polynomial forces, against a matrix exponential."""

import numpy as np
import pytest
from scipy.linalg import expm

from herringbone.kernels import modal


def propagator(w: float, zeta: float, h: float) -> np.ndarray:
    out = np.full(modal.PROPAGATOR + 4, np.nan)
    modal.propagator(w, zeta, h, out, 2, np.empty(modal.SCRATCH_SIZE))
    assert np.isnan(out[[0, 1, -2, -1]]).all()
    return out[2:-2]


def reference(w: float, zeta: float, h: float) -> np.ndarray:
    """Same numbers, from expm of the oscillator with a chain of integrators, in time units of h."""
    wh = w * h
    a = np.zeros((7, 7))
    a[0, 1] = 1.0
    a[1, :3] = -(wh**2), -2 * zeta * wh, 1.0
    a[[2, 3, 4, 5], [3, 4, 5, 6]] = 1.0
    e = expm(a)
    factorial = np.array([1.0, 1.0, 2.0, 6.0, 24.0])
    gamma = e[:2, 2:] * factorial * np.array([[h**2], [h]])
    phi = e[:2, :2] * np.array([[1.0, h], [1.0 / h, 1.0]])
    return np.concatenate([phi.ravel(), gamma.T.ravel()])


def sizes(w: float, h: float) -> np.ndarray:
    """Natural size of each entry: q by 1, v by w or 1/h, under a force by what it can reach."""
    v = max(w, 1.0 / h)
    return np.concatenate([[1.0, 1.0 / v, v, 1.0], np.tile([1.0, v], 5) * h / v])


def error(found: np.ndarray, exact: np.ndarray, w: float, h: float) -> float:
    return float((np.abs(found - exact) / sizes(w, h)).max())


CASES = [
    (w * 1.0, zeta, h)
    for h in (1e-9, 1e-5, 1e-3)
    for w in (0.0, 1e-3, 1.0, 1e3, 3e4, 1e5)
    for zeta in (0.0, 0.01, 0.3, 0.999999, 1.0, 1.000001, 3.0)
]


@pytest.mark.parametrize(("w", "zeta", "h"), CASES)
def test_against_matrix_exponential(w, zeta, h):
    # Asked: 1e-12. Squaring s times loses about 2**s eps, and w h <= 100 needs 8 of them.
    assert error(propagator(w, zeta, h), reference(w, zeta, h), w, h) < 1e-12


def test_rigid_mode_is_the_polynomial():
    h = 3e-4
    expected = [1.0, h, 0.0, 1.0]
    for j in range(5):
        expected += [h**2 / ((j + 1) * (j + 2)), h / (j + 1)]
    np.testing.assert_allclose(propagator(0.0, 0.0, h), expected, rtol=1e-14)


@pytest.mark.parametrize("cycles", [1, 10, 100, 1000])
def test_undamped_free_motion(cycles):
    w, h = 2 * np.pi * 1000.0, cycles * 1e-3 + 1e-4
    phi = propagator(w, 0.0, h)[:4]
    c, s = np.cos(w * h), np.sin(w * h)
    # Rounding of w h, and of scaling and squaring: a few eps w h.
    np.testing.assert_allclose(phi * [1, w, 1 / w, 1], [c, s, -s, c], atol=10 * 2.3e-16 * w * h)


@pytest.mark.parametrize("zeta", [0.0, 0.01, 1.0, 5.0])
def test_constant_force_settles_at_the_static_deflection(zeta):
    w, h = 2e3, 0.01
    p = propagator(w, zeta, h)
    # q = 1/w**2 at rest is a fixed point under the force 1.
    assert p[0] / w**2 + p[4] == pytest.approx(1 / w**2, rel=1e-12)
    assert p[2] / w**2 + p[5] == pytest.approx(0.0, abs=1e-12 / w)


def test_no_step_is_the_identity():
    expected = np.zeros(modal.PROPAGATOR)
    expected[[0, 3]] = 1.0
    np.testing.assert_array_equal(propagator(1e3, 0.02, 0.0), expected)


@pytest.mark.parametrize("h", [1e-16, 0.0999999])
def test_steps_that_masters_send(h):
    w, zeta = 2 * np.pi * 6900.0, 0.01  # highest pseudo mode of the shipped housing
    # w h up to 4300: 14 squarings; 2**14 eps = 4e-12, damped meanwhile.
    assert error(propagator(w, zeta, h), reference(w, zeta, h), w, h) < 1e-11


@pytest.mark.parametrize("degree", range(5))
def test_two_intervals_are_one_step_of_both(degree):
    """The force is a polynomial of degree p over two intervals; nothing else than rounding."""
    room, count, h = 4, 3, 2e-5
    rng = np.random.default_rng(degree)
    oscillators = [(0.0, 0.0), (3e3, 0.02), (6e4, 0.3)]
    phi = np.zeros((2, modal.PROPAGATOR, room))
    for i, (w, zeta) in enumerate(oscillators):
        for k in range(2):
            phi[k, :, i] = propagator(w, zeta, (k + 1) * h)
    f = np.zeros((modal.DEGREES, room))
    f[: degree + 1, :count] = rng.normal(size=(degree + 1, count))
    once, twice = np.zeros(2 * room), np.zeros(2 * room)
    once[:] = rng.normal(size=2 * room)
    once[:room] *= h
    twice[:] = once
    over_both = f * 2.0 ** np.arange(modal.DEGREES)[:, None]
    modal.advance(once, phi[1].ravel(), over_both.ravel(), degree, room, count)
    for _ in range(2):
        modal.advance(twice, phi[0].ravel(), f.ravel(), degree, room, count)
        f = f.ravel()
        modal.next_interval(f, degree, room, count)
    np.testing.assert_allclose(twice[:room], once[:room], rtol=1e-12, atol=1e-12 * h)
    np.testing.assert_allclose(twice[room:], once[room:], rtol=1e-12, atol=1e-12)
    powers = over_both.sum(axis=0)  # the force at the end of both
    np.testing.assert_allclose(f[:count], powers[:count], rtol=1e-12)

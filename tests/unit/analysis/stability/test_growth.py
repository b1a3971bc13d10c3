"""The fastest motion of matrices with known eigenvalues."""

import numpy as np
import pytest

from herringbone.analysis.stability.growth import Growth, growth_of, pair_growth

SIZE, STEP = 180, 1e-3
KNOWN = 1e-8
"""Of an eigenvalue: its residual, times the condition of the vectors, below 10."""


def matrix_of(eigenvalues):
    """A matrix with these and others of sizes up to 0.999, its vectors not orthogonal."""
    random = np.random.default_rng(3)
    blocks = np.zeros((SIZE, SIZE))
    at = 0
    for value in eigenvalues:
        blocks[at, at] = value.real
        if value.imag:
            blocks[at : at + 2, at : at + 2] = [[value.real, value.imag], [-value.imag, value.real]]
            at += 1
        at += 1
    for k in range(at, SIZE, 2):
        size, angle = random.uniform(0.5, 0.999), random.uniform(0.0, np.pi)
        turned = [[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]
        blocks[k : k + 2, k : k + 2] = size * np.array(turned)[: SIZE - k, : SIZE - k]
    vectors = np.eye(SIZE) + 0.05 * random.standard_normal((SIZE, SIZE)) / np.sqrt(SIZE)
    return vectors @ blocks @ np.linalg.inv(vectors)


@pytest.mark.parametrize(
    "fastest",
    [1.3 * np.exp(2.0j), -1.06 + 0j, 1.05 * np.exp(0.5j), 1.2 * np.exp(0.1j), 1.01 * np.exp(2.0j)],
)
def test_fastest_motion(fastest):
    """Clear growth and slight one, fast and slow, alone and beside another of nearly the size."""
    for others in ((), (0.999 * abs(fastest) * np.exp(1.4j),)):
        found = growth_of(matrix_of((fastest, *others)), STEP)
        assert found.radius == pytest.approx(abs(fastest), rel=KNOWN)
        expected = abs(np.angle(fastest)) / (2.0 * np.pi * STEP)
        assert found.frequency == pytest.approx(expected, rel=10.0 * KNOWN)
        if abs(fastest - 1.0) > 0.3:
            assert found.fast_radius == found.radius
            assert found.fast_change == pytest.approx(abs(fastest - 1.0), rel=KNOWN)


def test_free_rotation_is_no_growth():
    """A double eigenvalue of 1, with which a vector grows as time."""
    decaying = 0.999 * np.exp(2.0j)
    matrix = np.eye(2 + SIZE)
    matrix[0, 1], matrix[2:, 2:] = 1.0, matrix_of((decaying,))
    found = growth_of(matrix, STEP)
    assert found.radius == pytest.approx(abs(decaying), rel=KNOWN)
    assert found.frequency == pytest.approx(2.0 / (2.0 * np.pi * STEP), rel=10.0 * KNOWN)


def _split(above, below):
    """Free rotation whose double eigenvalue errors have moved, and a motion that decays."""
    matrix = np.eye(2 + SIZE)
    matrix[0, 0], matrix[1, 1], matrix[0, 1] = 1.0 + above, 1.0 - below, 1.0
    matrix[2:, 2:] = matrix_of((0.999 * np.exp(2.0j),))
    return growth_of(matrix, STEP, noise=1e-12).radius


def test_free_rotation_that_errors_have_split():
    """Evenly, it is as it was; where one part grows more, or by much, it grows."""
    assert _split(2e-4, 2e-4) == pytest.approx(0.999, rel=KNOWN)
    assert _split(2e-4, 1e-4) == pytest.approx(1.0 + 2e-4, rel=KNOWN)
    assert _split(1e-3, 1e-3) == pytest.approx(1.0 + 1e-3, rel=KNOWN)


def _turning(mean, apart):
    """Free rotation whose eigenvalues are `mean` +- the root of `apart` from 1, and a decay."""
    matrix = np.zeros((2 + SIZE, 2 + SIZE))
    matrix[:2, :2] = [[1.0 + mean, 1.0], [apart, 1.0 + mean]]
    matrix[2:, 2:] = matrix_of((0.999 * np.exp(2.0j),))
    return matrix


@pytest.mark.parametrize("apart", [4e-8, -4e-8, 1e-9, -1e-10])
def test_the_mean_of_free_rotation_is_left_by_errors(apart):
    """However far errors split the two, and whether they turn or not."""
    growth = 2e-6
    matrix = _turning(growth, apart)
    assert pair_growth(matrix, growth_of(matrix, STEP), STEP) == pytest.approx(growth, abs=KNOWN)


def test_what_is_no_free_rotation_has_no_mean():
    """Too far apart for errors, or another motion."""
    assert pair_growth(_turning(2e-6, 1e-6), None, STEP) is None
    assert pair_growth(_turning(2e-6, 4e-8), Growth(1.2, 300.0, 1.2), STEP) is None


def test_slow_growth_is_left_out_up_to_what_is_asked():
    """Growth by 3e-5 a step, as a part's own inner steps make it: told, unless it is left out."""
    matrix = np.eye(1 + SIZE)
    matrix[0, 0], matrix[1:, 1:] = 1.0 + 3e-5, matrix_of((0.999 * np.exp(2.0j),))
    assert growth_of(matrix, STEP).radius == pytest.approx(1.0 + 3e-5, rel=KNOWN)
    assert growth_of(matrix, STEP, rigid=4e-5).radius == pytest.approx(0.999, rel=KNOWN)

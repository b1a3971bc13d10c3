"""Modes of real matrices: what they are by definition, and those of matrices that are known."""

import numpy as np
import pytest

from herringbone.kernels.eigen.vectors import modes, room

DRAWN = np.random.default_rng(17)


def found(matrix):
    """Eigenvalues (imag >= 0), their columns and inverse rows."""
    n = len(matrix)
    real, imag, shapes, back = np.zeros(n), np.zeros(n), np.zeros(n * n), np.zeros(n * n)
    count = modes(matrix.flatten(), real, imag, shapes, back, np.zeros(room(n)), n)
    return real[:count], imag[:count], shapes.reshape(n, n), back.reshape(n, n)


def blocks(real, imag):
    """Block diagonal matrix that the columns are turned into."""
    n = len(real) + np.count_nonzero(imag)
    matrix, k = np.zeros((n, n)), 0
    for a, b in zip(real, imag, strict=True):
        if b == 0.0:
            matrix[k, k] = a
            k += 1
        else:
            matrix[k : k + 2, k : k + 2] = [[a, b], [-b, a]]
            k += 2
    return matrix


@pytest.mark.parametrize("n", [1, 2, 3, 8, 40])
@pytest.mark.parametrize("spread", [0.0, 6.0])
def test_columns_are_invariant(n, spread):
    """To rounding, n eps times the condition of the columns; rows and columns of unlike size."""
    scale = 10.0 ** DRAWN.uniform(-spread, spread, n)
    matrix = DRAWN.normal(size=(n, n)) * scale[:, None] / scale
    real, imag, shapes, back = found(matrix)
    alike = shapes / scale[:, None]
    condition = np.linalg.cond(alike / np.abs(alike).max(axis=0))
    rounding = 50.0 * n * np.finfo(float).eps * condition
    assert back @ shapes == pytest.approx(np.eye(n), abs=rounding)
    size = np.abs(matrix * scale / scale[:, None]).max() * n
    assert back @ matrix @ shapes == pytest.approx(blocks(real, imag), abs=rounding * size)


@pytest.mark.parametrize("decades", [4, 6])
def test_small_rows_keep_their_digits(decades):
    """Static deflections by the modes of a matrix whose rows and columns have sizes in any order.

    To rounding, n eps times the condition of what is left without the sizes, and of the columns;
    unsorted, it is 1e-9 and 1e-5.
    """
    n, chance = 20, np.random.default_rng(0)
    size = 10.0 ** chance.uniform(-decades, 0.0, n)
    alike = np.eye(n) + 0.3 / np.sqrt(n) * chance.normal(size=(n, n))
    force = chance.normal(size=n)
    real, imag, shapes, back = found(size[:, None] * alike * size)
    deflections = shapes @ np.linalg.solve(blocks(real, imag), back @ (size * force))
    expected = np.linalg.solve(alike, force) / size
    rounding = 50.0 * n * np.finfo(float).eps * np.linalg.cond(alike) * np.linalg.cond(shapes)
    assert rounding < 1e-11
    assert deflections == pytest.approx(expected, rel=rounding)


def test_known_eigenvalues():
    """Of a chain of n masses: w_k = 2 sin(k pi / (2 n + 2)), damped by zeta w / 2; a free mass."""
    n, damping = 12, 0.01
    stiffness = 2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    matrix = np.zeros((2 * n + 1, 2 * n + 1))
    matrix[:n, n : 2 * n] = np.eye(n)
    matrix[n : 2 * n, :n], matrix[n : 2 * n, n : 2 * n] = -stiffness, -damping * np.eye(n)
    real, imag, _, _ = found(matrix)
    squares = 4.0 * np.sin(np.arange(1, n + 1) * np.pi / (2 * n + 2)) ** 2
    expected = np.sqrt(squares - 0.25 * damping**2)
    assert np.sort(imag) == pytest.approx(np.concatenate([[0.0], expected]), abs=1e-13)
    oscillating = imag > 0.0
    assert real[oscillating] == pytest.approx(-0.5 * damping, abs=1e-13)
    assert np.abs(real[~oscillating]) == pytest.approx(0.0, abs=1e-13)

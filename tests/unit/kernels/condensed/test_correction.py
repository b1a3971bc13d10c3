"""One step of Newton for the laws' inputs: by sweeps, or by elimination where they do not end."""

import numpy as np
import pytest

from herringbone.kernels.condensed.collocation import Nodes, Table
from herringbone.kernels.condensed.correction import correct, make_room

UNKNOWNS, INNER = 2, 4
SIZE = UNKNOWNS * INNER
MEAN = 5.0
NO_REALS, NO_INTEGERS = np.zeros(0), np.zeros(0, dtype=np.int64)


def corrected(answers, rest, residuals):
    """Corrections, and those of the dense system, x - rest * (answers x) = residuals.

    Args:
        answers: (nodes, unknowns, size) of each law's argument to the inputs.
        rest: (nodes, unknowns) tangents less their means.
        residuals: (size,).
    """
    values = np.arange(UNKNOWNS)
    table = Table(
        NO_INTEGERS,
        NO_INTEGERS,
        NO_REALS,
        values,
        np.full(UNKNOWNS, MEAN),
        values,
        NO_REALS,
        NO_REALS,
    )
    empty = np.zeros((INNER, 0))
    nodes = Nodes(empty.copy(), empty.copy(), MEAN + rest, empty.copy(), NO_REALS)
    room = make_room(UNKNOWNS, INNER, UNKNOWNS)
    room.r[:] = residuals
    along = np.ascontiguousarray(answers.transpose(2, 0, 1)).reshape(SIZE, -1)
    correct(table, nodes, along, room)
    rows = (rest[:, :, None] * answers).transpose(1, 0, 2).reshape(SIZE, SIZE)
    return room.r, np.linalg.solve(np.eye(SIZE) - rows, residuals)


@pytest.fixture
def drawn():
    return np.random.default_rng(17)


def test_what_acts_on_later_nodes_alone_is_solved_by_sweeps_to_rounding(drawn):
    """Even where it is strong: the matrix is triangular in the order of time."""
    node = np.tile(np.arange(INNER), UNKNOWNS)
    later = (node[None, :] < np.arange(INNER)[:, None])[:, None, :]
    answers = np.where(later, drawn.normal(size=(INNER, UNKNOWNS, SIZE)), 0.0)
    found, exact = corrected(answers, drawn.normal(size=(INNER, UNKNOWNS)), drawn.normal(size=SIZE))
    assert found == pytest.approx(exact, rel=1e-10, abs=1e-10)


def test_sweeps_end_close_to_the_solution(drawn):
    """Rows of sum s at most: what is left is at most s / (1 - s) of the last change, a tenth."""
    answers = drawn.uniform(-1.0, 1.0, size=(INNER, UNKNOWNS, SIZE)) * 0.2 / SIZE
    found, exact = corrected(answers, np.ones((INNER, UNKNOWNS)), drawn.normal(size=SIZE))
    assert np.abs(found - exact).max() <= 0.2 / 0.8 * 0.1 * np.abs(found).max()
    assert np.abs(found - exact).max() > 0.0


def test_without_an_end_of_the_sweeps_by_elimination(drawn):
    """Sweeps would grow without bound: a node's answer to its own input is 3 times the input."""
    answers = 0.1 * drawn.normal(size=(INNER, UNKNOWNS, SIZE))
    for unknown in range(UNKNOWNS):
        for node in range(INNER):
            answers[node, unknown, unknown * INNER + node] = 3.0
    found, exact = corrected(answers, np.ones((INNER, UNKNOWNS)), drawn.normal(size=SIZE))
    assert found == pytest.approx(exact, rel=1e-10)


def test_a_law_whose_tangents_are_their_means_keeps_its_residual(drawn):
    residuals = np.concatenate([np.zeros(INNER), drawn.normal(size=INNER)])
    answers = drawn.normal(size=(INNER, UNKNOWNS, SIZE))
    found, exact = corrected(answers, np.zeros((INNER, UNKNOWNS)), residuals)
    assert found.tolist() == residuals.tolist() == exact.tolist()

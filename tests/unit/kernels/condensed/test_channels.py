"""Channels over a step: inputs from values at its nodes, and the values of the next step."""

import numpy as np
import pytest

from herringbone.analysis.twin.condensed.rungs import LOBATTO, continued
from herringbone.kernels.condensed.channels import inputs, predict

DEGREE = 4
NODES = np.array(LOBATTO[DEGREE])
COUNT = NODES.size


def chosen_inputs(values, least=0.0):
    """Inputs (nodes,) of one channel, and places of those that are chosen."""
    v, chosen = np.full((1, COUNT), np.nan), np.zeros(COUNT, dtype=np.int64)
    n = inputs(NODES, np.array([least]), np.array([values]), 0, 1, v, chosen)
    return v[0], chosen[:n].tolist()


def test_a_straight_line_costs_two_inputs():
    """Its bends are rounding: 1e-16 of the values, where 1e-13 is nothing."""
    v, chosen = chosen_inputs(3.0 + 0.7 * NODES)
    assert v[0] == 3.0
    assert v[-1] == pytest.approx(0.7, rel=1e-14)
    assert sorted(chosen) == [0, COUNT - 1]


def test_a_constant_costs_one_and_zero_none():
    assert chosen_inputs(np.full(COUNT, 2.0))[1] == [0]
    assert chosen_inputs(np.zeros(COUNT))[1] == []


def test_inputs_are_the_values():
    values = np.random.default_rng(5).normal(size=COUNT)
    v, chosen = chosen_inputs(values)
    above = np.append(np.insert(v[1:-1], 0, 0.0), 0.0)
    assert v[0] + NODES * v[-1] + above == pytest.approx(values, abs=1e-15)
    assert sorted(chosen) == list(range(COUNT))


def test_what_is_below_the_least_size_is_left_out():
    """Start 5, rise 0.1, above that line 1.5e-3 in all."""
    bend = 1e-3 * np.array([0.0, 0.5, 0.5, 0.5, 0.0])
    values = 5.0 + 0.1 * NODES + bend
    for least, places in [(1e-3, 5), (1e-2, 2), (1.0, 1), (10.0, 0)]:
        assert len(chosen_inputs(values, least)[1]) == places


def test_what_is_not_finite_is_an_input_whatever_is_least():
    assert chosen_inputs(np.full(COUNT, np.nan), 10.0)[1] != []


@pytest.mark.parametrize("share", [0.5, 1.0, 2.0])
def test_a_polynomial_is_continued(share):
    """Over a step of a share of the last one's length; exact but for rounding."""
    u = np.polyval([0.3, -0.2, 0.5, 1.0], NODES)[None, :]
    to = np.zeros_like(u)
    predict(np.ascontiguousarray(continued(DEGREE, DEGREE, share).T), True, 1, u, to)
    assert to[0] == pytest.approx(np.polyval([0.3, -0.2, 0.5, 1.0], 1.0 + share * NODES), rel=1e-11)
    predict(np.eye(COUNT), False, 1, u, to)
    assert to[0].tolist() == [u[0, -1]] * COUNT

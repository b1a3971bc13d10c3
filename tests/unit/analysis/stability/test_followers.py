"""Signals that follow from states: fewer rows, the same other eigenvalues."""

import numpy as np
import pytest

from herringbone.analysis.stability.followers import Followers

STATES, FOLLOWING, OTHERS = 30, 8, 12


def matrix(random, shares):
    """Of states, signals that are so many shares of them, and other signals."""
    free = random.standard_normal((STATES + OTHERS, STATES + FOLLOWING + OTHERS))
    free /= np.sqrt(free.shape[1])
    return np.vstack([free[:STATES], shares @ free[:STATES], free[STATES:]])


def sizes_of(values):
    return np.sort(np.abs(values))[::-1]


def test_same_eigenvalues_of_fewer_rows():
    """At the first matrix and at others, of units that are 1e6 apart."""
    random = np.random.default_rng(5)
    shares = random.standard_normal((FOLLOWING, STATES))
    units = 10.0 ** random.uniform(-3.0, 3.0, STATES + FOLLOWING + OTHERS)
    followers = Followers(STATES, units)
    for _ in range(3):
        whole = matrix(random, shares)
        found = followers.left_out(whole * units[:, None] / units)
        assert len(found) == STATES + OTHERS
        expected = sizes_of(np.linalg.eigvals(whole))
        assert np.all(expected[STATES + OTHERS :] < 1e-6)  # those that are lost are 0
        assert sizes_of(np.linalg.eigvals(found)) == pytest.approx(
            expected[: STATES + OTHERS], rel=1e-9
        )


def test_what_no_longer_follows_stays():
    random = np.random.default_rng(6)
    shares = random.standard_normal((FOLLOWING, STATES))
    followers = Followers(STATES, np.ones(STATES + FOLLOWING + OTHERS))
    assert len(followers.left_out(matrix(random, shares))) == STATES + OTHERS
    other = matrix(random, shares)
    other[STATES] *= 1.0 + 1e-6
    assert followers.left_out(other) is other

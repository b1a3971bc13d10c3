"""Fixed points that plain iteration runs away from."""

import numpy as np

from herringbone.running.settling.anderson import Anderson


def test_linear_map_that_enlarges():
    """As many steps as values, and one, whatever the size of the map: here up to 1000."""
    random = np.random.default_rng(3)
    count = 4
    slope = random.normal(size=(count, count)) * np.array([1000.0, 10.0, 1.0, 0.1])
    fixed = random.normal(size=count)
    search, z = Anderson(np.array([1.0, 10.0, 0.1, 1.0])), np.zeros(count)
    for _ in range(count + 1):
        z = search.next(z, fixed + slope @ (z - fixed))
    # Rounding grows with the condition of the differences, some 1e4 a step.
    assert np.abs(z - fixed).max() < 1e-6

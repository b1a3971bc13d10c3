"""Scans of the growth over the macro step look at what they need."""

from herringbone.analysis.stability.growth import Growth
from herringbone.analysis.stability.steps.step_scan import first_unstable_near

LIMIT = 1e-4


def test_nothing_above_the_first_unstable_step_is_looked_at():
    """Each step costs the eigenvalues of a matrix; edges are known to 0.25 %, steps are 0.5 %."""
    seen = []

    def growth(step):
        seen.append(step)
        return Growth(1.1 if step >= LIMIT else 0.9, 0.0, 0.0, near_mirror=0.99)

    found = first_unstable_near(growth, LIMIT)
    assert LIMIT <= found <= 1.0025 * LIMIT or found <= LIMIT <= 1.0025 * found
    assert max(seen) <= 1.01 * LIMIT

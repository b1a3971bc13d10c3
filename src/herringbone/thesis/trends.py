"""What a row of levels says of a sentence about a trend."""

from collections.abc import Sequence

import numpy as np

LEAST = 0.01
"""Change from one level to the next, over the level, that a reader of a curve can see."""


def rises(levels: Sequence[float], least: float = LEAST) -> bool:
    """True if each level is larger than the one before, by a share that counts."""
    found = np.asarray(levels, dtype=float)
    return bool((np.diff(found) > least * found[:-1]).all())


def growth(levels: Sequence[float]) -> float:
    """Change from the first to the last level [%]."""
    return 100.0 * (levels[-1] / levels[0] - 1.0)

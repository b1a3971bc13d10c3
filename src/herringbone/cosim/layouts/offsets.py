"""Offsets of rows that lie one behind the other in a flat array (CSR)."""

from collections.abc import Sequence

import numpy as np


def offsets(sizes: Sequence[int]) -> np.ndarray:
    """Where each of n rows begins, and where the last one ends (n + 1,)."""
    return np.concatenate(([0], np.cumsum(sizes, dtype=np.int64))).astype(np.int64)

"""Curves over two mesh periods, as pictures show them."""

import numpy as np
import pandas as pd


def two_periods(phase: pd.Series, values: pd.Series) -> tuple[np.ndarray, np.ndarray]:
    """Phases and values (2 n + 1,) of two periods and the beginning of a third.

    Args:
        phase: (n,) of one period [mesh periods].
        values: (n,) there.
    """
    once, at = np.asarray(values), np.asarray(phase)
    return np.concatenate([at, at + 1.0, [2.0 + at[0]]]), np.concatenate([once, once, once[:1]])

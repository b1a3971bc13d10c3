"""The error of a co-simulation against its monolithic twin."""

import numpy as np


def relative_error(values: np.ndarray, twin: np.ndarray) -> float:
    """Norm of (co-simulation - twin) over the norm of (twin - its time mean).

    Both norms are over time and channels, at communication points, over the whole run.

    Args:
        values, twin: (times, channels), the same unit in all channels.

    Returns:
        The relative error [1]; infinite if the twin does not vary.
    """
    variation = np.linalg.norm(twin - twin.mean(axis=0))
    return float(np.linalg.norm(values - twin) / variation) if variation > 0.0 else float("inf")

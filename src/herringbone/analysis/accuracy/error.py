"""The error of a co-simulation against its monolithic twin."""

import numpy as np


def relative_error(values: np.ndarray, twin: np.ndarray, time: np.ndarray | None = None) -> float:
    """Norm of (co-simulation - twin) over the norm of (twin - its time mean).

    Both norms are over time and channels, at communication points, over the whole run.

    Args:
        values, twin: (times, channels), the same unit in all channels.
        time: (times,) [s], if the communication points are not equidistant; at least two.

    Returns:
        The relative error [1]; infinite if the twin does not vary.
    """
    weight = np.ones(len(twin)) if time is None else np.gradient(time)
    root = np.sqrt(weight)[:, None]
    variation = np.linalg.norm(root * (twin - np.average(twin, axis=0, weights=weight)))
    return float(np.linalg.norm(root * (values - twin)) / variation) if variation else float("inf")

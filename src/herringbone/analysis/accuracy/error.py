"""The error of a co-simulation against its monolithic twin."""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np


class Rows(NamedTuple):
    """Values (times, columns) at communication points, and the names of the columns."""

    values: np.ndarray
    names: Sequence[str]

    def of(self, columns: Sequence[str]) -> np.ndarray:
        """Values (times, columns) of some columns."""
        return self.values[:, [self.names.index(column) for column in columns]]


def errors_by_group(
    groups: Mapping[str, Sequence[str]], run: Rows, exact: Rows, time: np.ndarray | None = None
) -> dict[str, float]:
    """Relative error of each group of columns; infinite where a run has grown beyond numbers.

    Args:
        groups: columns by group.
        run, exact: at the same times.
        time: see `relative_error`.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        errors = {
            group: relative_error(run.of(columns), exact.of(columns), time)
            for group, columns in groups.items()
        }
    return {group: e if math.isfinite(e) else math.inf for group, e in errors.items()}


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

"""How far an input is changed in a trial: by its value, its nominal value or its unit."""

import math

import numpy as np

from herringbone.core.part import PartVariable

_SHARE = 1e-3
_BY_UNIT = {
    "N": 1.0,
    "N.m": 0.1,
    "m": 1e-6,
    "rad": 1e-5,
    "m/s": 1e-4,
    "rad/s": 1e-3,
    "m/s2": 1e-2,
    "rad/s2": 1.0,
}
_OTHER = 1e-3
RATIO = 16.0
"""The larger change over the smaller one."""


def unlike(changes: np.ndarray) -> np.ndarray:
    """Changes of all inputs at once that no difference of two inputs cancels."""
    return changes * (1.0 + 0.618 * np.arange(changes.size))


def amplitude(variable: PartVariable, start: float) -> float:
    """The larger change of an input [its unit]; a power of two, so that it is added exactly."""
    size = max(_SHARE * abs(start), _BY_UNIT.get(variable.unit or "", _OTHER))
    return 2.0 ** math.floor(math.log2(size))

"""The ticks of a part whose outputs do not change in every step, however short."""

import numpy as np

from herringbone.cosim.signature.amplitudes import unlike
from herringbone.cosim.signature.laboratory import Laboratory

_FINE = 16
_STEPS = 24
_LONG = 400
_SEEN = 4
"""Changes that it takes to tell a tick."""
_FEW = 0.5
"""Share of steps with a change below which a part has ticks."""


def tick_of(lab: Laboratory, changes: np.ndarray) -> float:
    """Time between changes of the outputs after all inputs were changed [s]; 0: no ticks.

    Steps of 1/16 of the laboratory's are tried first, where the part takes them, then whole ones,
    which find long ticks.

    Raises:
        Refused: the part refuses whole steps.
    """
    fine = [(lab.step / _FINE, _FINE * _STEPS)] if not lab.grain else []
    for h, steps in (*fine, (lab.step, _LONG)):
        moved = _changes(lab, changes, h, steps)
        if moved.size < _SEEN:
            continue
        if moved.size >= _FEW * steps:
            return 0.0
        apart = np.diff(moved[1:])  # the first one may be that of the start
        if np.ptp(apart) <= 1:
            return float(np.mean(apart)) * h
        return 0.0
    return 0.0


def _changes(lab: Laboratory, changes: np.ndarray, h: float, steps: int) -> np.ndarray:
    """Numbers of the steps in which any output changed, while inputs rise evenly."""
    rise = unlike(changes) / steps
    inputs = [lab.start + (k + 1.0) * rise for k in range(steps)]
    path = lab.run(inputs, h)
    return np.flatnonzero(np.any(path[1:] != path[:-1], axis=1))

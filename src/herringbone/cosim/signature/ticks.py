"""The ticks of a part whose outputs, or states, do not change in every step, however short."""

import numpy as np

from herringbone.cosim.signature.amplitudes import unlike
from herringbone.cosim.signature.laboratory import Laboratory

_FINE = 16
_STEPS = 24
_LONG, _LONG_INNER = 400, 100
_SEEN = 4
"""Changes that it takes to tell a tick."""
_FEW = 0.5
"""Share of steps with a change up to which a part has ticks."""


def tick_of(lab: Laboratory, changes: np.ndarray) -> float:
    """Time between changes of the outputs while all inputs rise evenly [s]; 0: no ticks.

    Steps of 1/16 of the laboratory's are tried first, where the part takes them, then whole ones,
    which find long ticks.

    Raises:
        Refused: the part refuses whole steps.
    """
    fine = [(lab.step / _FINE, _FINE * _STEPS)] if not lab.grain else []
    for h, steps in (*fine, (lab.step, _LONG)):
        moved = _changes(lab, changes, h, steps, rising=True)
        if moved.size >= _SEEN:
            return _apart(moved, steps) * h
    return 0.0


def inner_tick_of(lab: Laboratory, changes: np.ndarray, *, remembers: bool) -> float:
    """The same while changed inputs stay: what changes then are the states behind them.

    Where inputs pass directly to outputs, these change with every input, and hide ticks of states.

    Args:
        lab, changes: of the part.
        remembers: a pulse of one step leaves something, so that no tick is longer than that.

    Raises:
        Refused: the part does.
    """
    h, steps = (lab.step / _FINE, _FINE * _STEPS) if remembers else (lab.step, _LONG_INNER)
    if remembers and _changes(lab, changes, h, _FINE, rising=False).size == _FINE:
        return 0.0  # no ticks, as of most parts, by few trials
    return _apart(_changes(lab, changes, h, steps, rising=False), steps) * h


def _apart(moved: np.ndarray, steps: int) -> float:
    """By how many steps ticks are apart; 0: they are none.

    Args:
        moved: numbers of the steps that changed something; the first may be that of the start.
        steps: of the run.
    """
    if moved.size < _SEEN or moved.size - 1 > _FEW * steps:
        return 0.0
    apart = np.diff(moved[1:])
    even = np.ptp(apart) <= 1 and apart.max() > 1  # else it begins late, or comes to rest
    return float(np.mean(apart)) if even else 0.0


def _changes(
    lab: Laboratory, changes: np.ndarray, h: float, steps: int, *, rising: bool
) -> np.ndarray:
    """Numbers of the steps in which any output changed, while inputs rise evenly, or stay."""
    rise = unlike(changes) / steps
    inputs = [lab.start + (k + 1.0 if rising else steps) * rise for k in range(steps)]
    path = lab.run(inputs, h)
    return np.flatnonzero(np.any(path[1:] != path[:-1], axis=1))

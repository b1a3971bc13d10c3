"""Does a part grow as its model does? Trials that make a model may be too short to tell.

A part that does not stand still at the values that it declares, as a wheel that spins behind a hub
that is held, changes while it is tried. A linear model takes that for a pole.
"""

import math

import numpy as np

from herringbone.analysis.stability.surrogates.identification import LinearModel
from herringbone.analysis.stability.surrogates.trials import Trials
from herringbone.cosim.signature.trial import NOT_TRIED

_FOLDS, _EARLY = 20.0, 0.125
"""Powers of e by which the model grows in the trial at most, and share of it that is its begin."""
_SHOWS = 10.0
"""Growth over the largest answer in the begin: the trial ends there, before laws are left."""
_LASTING, _STEPS = 0.5, 240
"""Longest trial [s], and most steps of it."""
_SLOWEST = 8.0
"""Slower growth [1/s] does not show in the longest trial, and is left alone."""
_MISSED = 0.5
"""Of the model's answer: a part that is further off at the end does not grow as it does."""
_QUIET = 1e-9
"""Of outputs: smaller answers are rounding."""


def not_its_own(model: LinearModel, trials: Trials, base: float) -> str:
    """Why a growing model is not that of its part, "" if it does not grow or the part does, too.

    Args:
        model: of the part.
        trials: of the part.
        base: step of the trials that made the model [s].
    """
    growth = float(np.linalg.eigvals(model.a).real.max(initial=-np.inf))
    if growth < _SLOWEST:
        return ""
    lasting = min(_FOLDS / growth, _LASTING)
    h = max(base, lasting / _STEPS)
    pulse = trials.pulse(math.ceil(lasting / h))
    told = model.over(h).answers(pulse)
    steps = _shown(np.abs(told).max(axis=1))
    try:
        truth, rest = trials.answers(pulse[:steps], h)
    except NOT_TRIED:
        return ""
    late = slice(steps // 2, steps)
    last = np.abs(told[late]).max(axis=0)
    heard = last > _QUIET * np.abs(rest).max(axis=0)
    if np.all(np.abs(truth - told[:steps])[late].max(axis=0)[heard] <= _MISSED * last[heard]):
        return ""
    return (
        f"its linear model grows as exp({growth:.3g} t/s), which it does not do itself in "
        f"{steps * h:.2g} s: it is not steady where it is tried; set start values that are "
        "steady together"
    )


def _shown(sizes: np.ndarray) -> int:
    """Steps until growth of answers (steps,) shows; what is direct ends with the first one."""
    early = sizes[1 : max(2, int(_EARLY * len(sizes)))].max(initial=0.0)
    above = np.flatnonzero(sizes[1:] > _SHOWS * early)
    return int(above[0]) + 2 if above.size else len(sizes)

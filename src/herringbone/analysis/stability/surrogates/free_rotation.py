"""Models of parts that turn freely: what no short trial tells, and the way to the start does."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from herringbone.analysis.stability.surrogates.identification import LinearModel

FREE = 0.02
"""Slower motions [1/s] are of what turns freely or integrates: nothing is steady then."""
_MISSED = 0.01
"""Of what an angle changes at once; a model that is further off is left alone."""


def for_good(model: LinearModel, column: int) -> np.ndarray:
    """(m,) what a step of an input makes of the outputs for good; NaN if they do not settle."""
    if not len(model.a):
        return model.d[:, column]
    if np.abs(np.linalg.eigvals(model.a)).min() < FREE:
        return np.full(len(model.d), np.nan)
    return model.d[:, column] - model.c @ np.linalg.solve(model.a, model.b[:, column])


def turning_freely(model: LinearModel, angles: Sequence[int]) -> LinearModel:
    """The model whose outputs do not depend for good on angles that have turned on and on.

    A part that has settled while an angle turned by many radians is held by no spring there. Of a
    model that errs by 1e-4 of the shaft's stiffness, a rotation would grow or die out in seconds.

    Args:
        model: of the part.
        angles: numbers of the inputs.
    """
    d = model.d.copy()
    for column in angles:
        left = for_good(model, column)
        if np.abs(left).max(initial=0.0) <= _MISSED * np.abs(d[:, column]).max(initial=0.0):
            d[:, column] -= left
    return replace(model, d=d)

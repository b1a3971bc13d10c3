"""Outputs that are called the time derivative of others: the trials tell whether they are.

Over some steps the change of s is compared with the integral of v by Simpson's rule, while all
inputs are changed, so that both move. A part that integrates by Euler's rule errs by the first
power of one over the number of steps, which is removed by extrapolation from two numbers.
"""

from collections.abc import Mapping

import numpy as np

from herringbone.core.part import PartVariable
from herringbone.cosim.signature.amplitudes import unlike
from herringbone.cosim.signature.laboratory import Laboratory
from herringbone.cosim.signature.signature import Answer, Rate
from herringbone.cosim.structure.rates import named_rate

_STEPS = 32
_RIGHT = 0.02
_WRONG = 0.1
_ROUNDING = 1e5 * float(np.finfo(float).eps)


def rates_of(
    lab: Laboratory,
    variables: Mapping[str, PartVariable],
    changes: np.ndarray,
    feedthrough: np.ndarray,
) -> tuple[Rate, ...]:
    """Pairs of outputs that a declaration or their names call rates of each other, tested.

    An output that inputs pass to moves as they do; it is left out.

    Raises:
        Refused: the part refuses the steps.
    """
    pairs = []
    for name in lab.outputs:
        declared = variables[name].rate
        rate = named_rate(name, lab.outputs) if declared is None else declared
        passed = feedthrough[lab.outputs.index(name)]
        if rate and rate in lab.outputs and not np.nan_to_num(passed, nan=1.0).any():
            pairs.append((name, rate))
    if not pairs:
        return ()
    moved = lab.start + 16.0 * unlike(changes)
    h = lab.step
    path = lab.run([moved] * _STEPS, h)
    return tuple(_rate(lab, path, h, pair) for pair in pairs)


def _rate(lab: Laboratory, path: np.ndarray, h: float, pair: tuple[str, str]) -> Rate:
    of, rate = (path[:, lab.outputs.index(name)] for name in pair)
    ratios = []
    for steps in (_STEPS // 2, _STEPS):
        change = float(of[steps] - of[0])
        integral = float(_simpson(steps) @ rate[: steps + 1]) * h
        rounding = _ROUNDING * max(float(np.abs(of).max()), abs(integral))
        if max(abs(change), abs(integral)) <= rounding:
            return Rate(*pair, None, Answer.UNKNOWN)
        if abs(integral) <= rounding:
            return Rate(*pair, None, Answer.NO)
        ratios.append(change / integral)
    ratio = 2.0 * ratios[1] - ratios[0]
    off = abs(ratio - 1.0)
    holds = Answer.YES if off <= _RIGHT else Answer.NO if off > _WRONG else Answer.UNKNOWN
    return Rate(*pair, ratio, holds)


def _simpson(steps: int) -> np.ndarray:
    """Weights of the values at an even number of steps of unit length."""
    weights = np.ones(steps + 1)
    weights[1:-1:2], weights[2:-1:2] = 4.0, 2.0
    return weights / 3.0

r"""What a part makes of an input and its rate inside a step: the rotation test.

An angle that rises evenly, phi = w t, with its speed w, a little faster than at the start, is given
to the part in steps of H, H/2 and H/4, by three rules; in each of them outputs at the end are
y + D (u_end - u_seen):

    held    the mean of the step is given, and seen to its end
    start   the value at the start is given; the part turns it on by w H, and sees that at the end
    end     the value at the end is given; the part turns it back to the start itself

With the right rule outputs at a fixed time depend on H by its second power only, with a wrong one
by the first: a part of stiffness k at its flange gets a torque that is off by k w H / 2.
"""

from enum import IntEnum

import numpy as np

from herringbone.cosim.signature.laboratory import Laboratory
from herringbone.cosim.structure.rates import named_rate

_STEPS = 8
_HALVINGS = 3
_BETTER = 4.0
"""How much smaller the dependence on H must be than by both other rules, one of which needs no
knowledge: where inner steps do not divide H all of them depend on it."""


class InputRule(IntEnum):
    """Which value of an input a part is to be given for a step: the rules above."""

    MEAN = 0
    START = 1
    END = 2


def pairs(inputs: tuple[str, ...], together: tuple[int, ...]) -> list[tuple[int, int]]:
    """Numbers of inputs and of what may be their rates: by names, or by what acts alike.

    Args:
        inputs: names.
        together: for each input the number of one whose integral acts like it, or -1.
    """
    found = []
    for number, name in enumerate(inputs):
        rate = named_rate(name, inputs)
        other = inputs.index(rate) if rate else together[number]
        if other >= 0:
            found.append((number, other))
    return found


def rule_of(
    lab: Laboratory, pair: tuple[int, int], speed: float, feedthrough: np.ndarray, tick: float
) -> InputRule:
    """The rule that a part follows with an input and its rate; raises Refused.

    Args:
        lab: of the part.
        pair: numbers of the input and its rate.
        speed: of the trial, added to the rate's start.
        feedthrough: (m, n) D, 0 where it is unknown.
        tick: inner step [s], of which H, H/2 and H/4 are multiples then; 0: there is none.
    """
    step = 2.0 ** (_HALVINGS - 1) * tick if tick else lab.step
    off = [_dependence(lab, pair, speed, feedthrough, rule, step) for rule in InputRule]
    best = int(np.argmin(off))
    clear = _BETTER * off[best] < min(off[:best] + off[best + 1 :])
    return InputRule(best) if clear else InputRule.MEAN


def _dependence(
    lab: Laboratory,
    pair: tuple[int, int],
    speed: float,
    feedthrough: np.ndarray,
    rule: InputRule,
    step: float,
) -> float:
    """How much outputs at a fixed time depend on the step, by a rule."""
    ends = [
        _end(lab, pair, speed, feedthrough, rule, step / 2.0**k, _STEPS * 2**k)
        for k in range(_HALVINGS)
    ]
    size = np.abs(ends).max(axis=0)
    passed = np.abs(feedthrough[:, pair[0]]) > 0.0
    change = np.abs(ends[2] - ends[1])[passed] / np.maximum(size[passed], 1e-300)
    return float(change.max(initial=0.0))


def _end(
    lab: Laboratory,
    pair: tuple[int, int],
    speed: float,
    feedthrough: np.ndarray,
    rule: InputRule,
    h: float,
    steps: int,
) -> np.ndarray:
    """(m,) outputs after so many steps, with what passes directly at the end."""
    angle, rate = pair
    turning = lab.start[rate] + speed
    inputs = []
    for n in range(steps):
        values = lab.start.copy()
        values[rate] += speed
        place = {InputRule.MEAN: n + 0.5, InputRule.START: n, InputRule.END: n + 1.0}[rule]
        values[angle] += turning * place * h
        inputs.append(values)
    missing = {InputRule.MEAN: 0.5, InputRule.START: 0.0, InputRule.END: 0.0}[rule] * turning * h
    return lab.run(inputs, h)[-1] + feedthrough[:, angle] * missing

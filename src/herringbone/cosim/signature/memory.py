"""Memory and delay of a part: what a pulse at an input leaves behind.

An input is changed during one step, and what comes out is compared with the run without the change.
Outputs that differ after the pulse has gone remember it. An output that differs only in a later
step than the pulse's, by the same number of steps when they are half as long, has a delay of steps;
one that differs after the same time has a delay of its own, which is a state. Of a part that takes
steps of one length only both are the same.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from herringbone.cosim.signature.laboratory import Laboratory
from herringbone.cosim.signature.signature import Answer

_STEPS = 8
LONG = 1024
"""Steps in which an input that seems to do nothing may still come out."""
_NOTHING = 1e-9
"""Differences over the largest one that are rounding."""
_ROUNDING = 1e3 * float(np.finfo(float).eps)


class Pulses(NamedTuple):
    """Answers to pulses.

    Attributes:
        memory: of the part.
        delay: (m, n) see `Signature`.
    """

    memory: Answer
    delay: np.ndarray


def pulses(lab: Laboratory, changes: np.ndarray) -> Pulses:
    """Answers to a pulse at every input; raises Refused."""
    m, n = len(lab.outputs), len(lab.inputs)
    delay = np.full((m, n), -1)
    remembers = False
    short = [_differences(lab, _only(changes, k), lab.step, _STEPS) for k in range(n)]
    silent = [number for number in range(n) if not short[number].any()]
    late_ones = _late(lab, changes, silent)
    for number in range(n):
        apart = late_ones.get(number, short[number])
        seen = apart != 0.0
        reached = seen.any(axis=0)
        begins = np.argmax(seen, axis=0)
        delay[:, number] = np.where(reached, begins, -1)
        remembers = remembers or bool(seen[1:].any())
        late = reached & (begins > 0)
        if late.any() and not lab.grain:
            steps = 2 * len(apart)
            half = _differences(lab, _only(changes, number), 0.5 * lab.step, steps) != 0.0
            of_steps = np.argmax(half, axis=0) == begins
            delay[late & ~of_steps, number] = 0
    return Pulses(Answer.YES if remembers else Answer.NO, delay)


def _late(lab: Laboratory, changes: np.ndarray, silent: Sequence[int]) -> dict[int, np.ndarray]:
    """Answers over many steps of inputs that seem to do nothing; none where all of them stay so.

    They are changed all at once first: where nothing comes of that, as of inputs that nothing
    reads, it is one long run and not one each.
    """
    if not silent or not _differences(lab, _only(changes, silent), lab.step, LONG).any():
        return {}
    return {k: _differences(lab, _only(changes, k), lab.step, LONG) for k in silent}


def _only(changes: np.ndarray, number: int | Sequence[int]) -> np.ndarray:
    """Changes (n,) of these inputs alone."""
    found = np.zeros_like(changes)
    found[number] = changes[number]
    return found


def _differences(lab: Laboratory, changes: np.ndarray, h: float, steps: int) -> np.ndarray:
    """(steps, m) what a pulse (n,) in the first step changes; what is rounding is 0."""
    rest = [lab.start] * (steps - 1)
    base = lab.resting(h, steps)
    pulse = lab.run([lab.start + changes, *rest], h)[1:]
    apart = pulse - base
    floor = np.maximum(_ROUNDING * np.abs(base).max(axis=0), _NOTHING * np.abs(apart).max(axis=0))
    return np.where(np.abs(apart) > floor, apart, 0.0)

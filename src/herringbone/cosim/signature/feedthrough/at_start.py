"""Direct feedthrough of a part: D by two amplitudes and both signs of every input."""

import numpy as np

from herringbone.cosim.signature.amplitudes import RATIO
from herringbone.cosim.signature.feedthrough.response import (
    HALVINGS,
    Response,
    extrapolated,
    of_one_length,
)
from herringbone.cosim.signature.laboratory import Laboratory
from herringbone.cosim.signature.signature import Findings
from herringbone.cosim.signature.trial import Refused

ROUNDING = 1e4 * float(np.finfo(float).eps)
_SHORTER = 32.0
_ROUNDS = 3
SAME = 0.1
"""Feedthrough at two amplitudes, over the larger one, that is one number."""
_ALIKE = 0.2
"""Difference of two responses, over them, that are taken for one."""
_TINY, _KEEPS = 2.0**-20, 0.5
"""A change over the largest one, and what is left of the answer to that: it jumps. A law that rises
over more than twice the tiny change, as tanh(w / w_0) with a w_0 of that size, leaves less."""


def feedthrough_of(
    lab: Laboratory, largest: np.ndarray, grain: float, found: Findings
) -> tuple[np.ndarray, np.ndarray]:
    """(m, n) D, by both amplitudes and signs; and slopes of the responses [1/s].

    Args:
        lab: of the part.
        largest: (n,) changes of the inputs.
        grain: shortest step in which outputs change [s]; 0: any.
        found: lines are added to it.
    """
    shape = len(lab.outputs), len(lab.inputs)
    feedthrough, slopes = np.empty(shape), np.empty(shape)
    for number, name in enumerate(lab.inputs):
        changes = largest[number] * np.array([1.0, -1.0, 1.0 / RATIO, -1.0 / RATIO])
        found_by = [_column(lab, number, float(change), grain) for change in changes]
        by_change = np.array([response.feedthrough for response in found_by])
        slopes[:, number] = found_by[0].slope
        one = _one_number(by_change)
        bent = np.flatnonzero(np.isnan(one) & ~np.isnan(by_change).any(axis=0))
        feedthrough[:, number] = one
        found.bent |= set(map(int, bent))
        jumps = _jumps(lab, number, largest[number]) if bent.size else np.zeros(0)
        for row in bent:
            low, high = by_change[:, row].min(), by_change[:, row].max()
            found.note(
                f"{lab.outputs[row]} jumps by {abs(jumps[row]):.3g} as {name} leaves "
                f"{lab.start[number]:.6g}, however little: it is not linear there"
                if jumps[row]
                else f"d({lab.outputs[row]})/d({name}) lies between {low:.3g} and {high:.3g} for "
                f"changes up to {largest[number]:.3g}: it is not linear there"
            )
    return feedthrough, slopes


def _jumps(lab: Laboratory, number: int, largest: float) -> np.ndarray:
    """(m,) by how much outputs jump as an input leaves its start, to the worse side; 0: not."""
    found = np.zeros(len(lab.outputs))
    for change in (largest, -largest):
        answers = []
        for share in (1.0, _TINY):
            changed = lab.start.copy()
            changed[number] += share * change
            answers.append(lab.run([changed], lab.step)[-1] - lab.at_rest(lab.step))
        whole, tiny = answers
        jumped = (np.abs(tiny) >= _KEEPS * np.abs(whole)) & (np.abs(tiny) > np.abs(found))
        found = np.where(jumped, tiny, found)
    return found


def _column(lab: Laboratory, number: int, change: float, grain: float) -> Response:
    """D of one input at one change; shorter steps where the step does not tell."""
    step = lab.step if grain == 0.0 else 2.0 ** (HALVINGS - 1) * grain
    responses, floor = _responses(lab, number, change, step)
    found = extrapolated(responses, floor, step)
    if lab.grain:
        return of_one_length(found, responses[-1], floor)
    for _ in range(_ROUNDS):
        if grain or not np.isnan(found.feedthrough).any():
            break
        step /= _SHORTER
        try:
            shorter = extrapolated(*_responses(lab, number, change, step), step)
        except Refused:
            break
        unknown = np.isnan(found.feedthrough)
        found = Response(
            np.where(unknown, shorter.feedthrough, found.feedthrough),
            np.where(unknown, shorter.slope, found.slope),
        )
    return found


def _responses(
    lab: Laboratory, number: int, change: float, step: float
) -> tuple[np.ndarray, np.ndarray]:
    """(HALVINGS, m) responses after steps step / 2^k, and (m,) what of them is rounding."""
    changed = lab.start.copy()
    changed[number] += change
    found, size = [], np.zeros(len(lab.outputs))
    for k in range(HALVINGS):
        h = step / 2.0**k
        base = lab.at_rest(h)
        after = lab.run([changed], h)[-1]
        found.append((after - base) / change)
        size = np.maximum(size, np.maximum(np.abs(base), np.abs(after)))
    return np.array(found), ROUNDING * size / abs(change)


def _one_number(by_change: np.ndarray) -> np.ndarray:
    """(m,) D of one input where amplitudes and signs agree; else it is unknown.

    Args:
        by_change: (4, m) at the larger change, plus and minus, and at the smaller one.
    """
    spread, scale = np.ptp(by_change, axis=0), np.abs(by_change).max(axis=0)
    return np.where(spread > SAME * scale, np.nan, by_change[2:].mean(axis=0))


def runs_on(feedthrough: np.ndarray, slopes: np.ndarray) -> tuple[int, ...]:
    """For each input the one whose integral the part adds to it inside a step, or -1.

    Then a change of that one acts after a step h as if the input had changed by h times as much.

    Args:
        feedthrough: (m, n) D.
        slopes: (m, n) what responses grow by [1/s].
    """
    count = feedthrough.shape[1]
    found = []
    for number in range(count):
        passed = feedthrough[:, number]
        seen = np.nan_to_num(passed) != 0.0
        others = (
            k
            for k in range(count)
            if k != number
            and seen.any()
            and np.all(np.abs(slopes[seen, k] - passed[seen]) <= _ALIKE * np.abs(passed[seen]))
        )
        found.append(next(others, -1))
    return tuple(found)

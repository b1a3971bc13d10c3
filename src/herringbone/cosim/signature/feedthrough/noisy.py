"""What passes directly through a part whose outputs are noisy: means of repeated trials.

With K steps from the start on start inputs, and K with an input changed by a, the difference of the
means over a is known to

    e = T sqrt((s_0^2 + s_1^2) / K) / a,                             s: deviations of one output.

What is there after a step and after a quarter of it alike, far above e, passes directly; what falls
with the step does not. Changes grow until e is small; what still is not above it is unknown, and a
line tells noise and bound.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from herringbone.core.part import PartVariable
from herringbone.cosim.signature.amplitudes import RATIO, amplitude
from herringbone.cosim.signature.laboratory import Laboratory
from herringbone.cosim.signature.signature import Findings

REPEATS = 12
SURE = 5.0
"""T: deviations of a mean that count as its error."""
_SHORTER = 0.25
_CLEAR = 0.1
"""Error over a response that is told."""
_ROUNDS = 4
"""How many changes are tried, each 16 times as large as the last."""


class Mean(NamedTuple):
    """A response (m,) over the change, its error, and the noise of the outputs."""

    value: np.ndarray
    error: np.ndarray
    noise: np.ndarray


def noisy_feedthrough(
    lab: Laboratory, variables: Mapping[str, PartVariable], found: Findings
) -> np.ndarray:
    """(m, n) D where noise lets it be seen, nan elsewhere; lines tell how well. Raises Refused."""
    lengths = lab.step, _SHORTER * lab.step
    rests = [_repeated(lab, lab.start, h) for h in lengths]
    feedthrough = np.full((len(lab.outputs), len(lab.inputs)), np.nan)
    for number, name in enumerate(lab.inputs):
        change = amplitude(variables[name], float(lab.start[number]))
        for _ in range(_ROUNDS):
            long, short = (
                _response(lab, number, change, h, rest)
                for h, rest in zip(lengths, rests, strict=True)
            )
            if (short.error <= _CLEAR * np.abs(short.value)).all():
                break
            change *= RATIO
        else:
            change /= RATIO
        for row, output in enumerate(lab.outputs):
            value = _direct(*((m.value[row], m.error[row]) for m in (long, short)))
            feedthrough[row, number] = value
            found.note(_told(f"d({output})/d({name})", value, short, row, change))
    return feedthrough


def _repeated(lab: Laboratory, inputs: np.ndarray, h: float) -> np.ndarray:
    """(K, m) outputs after one step of h [s] from the start, again and again."""
    return np.array([lab.run([inputs], h)[-1] for _ in range(REPEATS)])


def _response(lab: Laboratory, number: int, change: float, h: float, rest: np.ndarray) -> Mean:
    changed = lab.start.copy()
    changed[number] += change
    moved = _repeated(lab, changed, h)
    spread = np.sqrt((rest.var(axis=0, ddof=1) + moved.var(axis=0, ddof=1)) / REPEATS)
    value = (moved.mean(axis=0) - rest.mean(axis=0)) / change
    return Mean(value, SURE * spread / abs(change), rest.std(axis=0, ddof=1))


def _direct(long: tuple[float, float], short: tuple[float, float]) -> float:
    """D by responses and their errors after a step and a quarter of it; nan: not known."""
    off, error = abs(long[0] - short[0]), long[1] + short[1]
    if error > _CLEAR * abs(long[0]):
        return np.nan
    if off <= error:
        return short[0]
    return 0.0 if abs(short[0]) <= 2.0 * _SHORTER * abs(long[0]) else np.nan


def _told(what: str, value: float, short: Mean, row: int, change: float) -> str:
    noise = f"noise of {short.noise[row]:.2g}"
    if np.isnan(value):
        bound = abs(short.value[row] * change) + short.error[row] * abs(change)
        return f"{what} is unknown: {noise}, a response below {bound:.2g} to {change:.3g}"
    if value == 0.0:
        return f"{what} = 0: what answers falls with the step, under {noise}"
    return f"{what} = {value:.3g} +- {short.error[row]:.1g} by {REPEATS} repeats, under {noise}"

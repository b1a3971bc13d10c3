"""How fast what is behind a part's own shaft turns at the start, by how its torque runs on.

While a flange is held, a shaft twists by the speed w of what is behind it: with D = d(tau)/d(phi)

    d(tau)/dt = -D w,    or -D (w - w_flange) if the part turns the flange on by itself.

The shaft's damper pushes w towards w_flange meanwhile, in proportion to what is between them: so
that a second trial, with the flange at the speed that was found first, tells by how much.
"""

import numpy as np

from herringbone.cosim.signature.laboratory import Laboratory
from herringbone.cosim.signature.rotation import InputRule
from herringbone.cosim.signature.trial import Refused

_SHARES = 0.25, 0.5, 1.0
"""Of the step, after which torques are looked at."""
_ALIKE = 1e-3
"""Of the larger speed: flange and what is behind it turn alike."""
_STIFF = 0.9
"""Share of a change of the flange's speed above which the damper hides what turns behind it."""


def inner_speeds(
    lab: Laboratory, feedthrough: np.ndarray, given: tuple[InputRule, ...], rate: tuple[int, ...]
) -> tuple[float, ...]:
    """(n,) speed behind each input that is an angle, in its unit per second; nan for others.

    Args:
        lab: entered.
        feedthrough: (m, n) D.
        given, rate: see `Signature`.
    """
    known = np.nan_to_num(feedthrough)

    def seen(angle: int, flange: float) -> float:
        """Speed by the torque, with the flange at a speed."""
        row = int(np.abs(known[:, angle]).argmax())
        inputs = lab.start.copy()
        inputs[rate[angle]] = flange
        change = _rate(*(float(lab.run([inputs], lab.step * s)[-1][row]) for s in _SHARES))
        own = flange if given[angle] is InputRule.START else 0.0
        return own - change / (lab.step * known[row, angle])

    def found(angle: int) -> float:
        if rate[angle] < 0 or not known[:, angle].any():
            return np.nan
        flange = float(lab.start[rate[angle]])
        try:
            first = seen(angle, flange)
            apart = first - flange
            if abs(apart) <= _ALIKE * max(abs(first), abs(flange)):
                return first
            share = (seen(angle, first) - first) / apart
        except Refused:
            return np.nan
        return flange + apart / (1.0 - share) if abs(share) < _STIFF else np.nan

    return tuple(map(found, range(len(lab.inputs))))


def _rate(quarter: float, half: float, whole: float) -> float:
    """Rate at the start times the step: both differences, extrapolated from their middles."""
    return 2.0 * (half - quarter) / 0.25 - (whole - half) / 0.5

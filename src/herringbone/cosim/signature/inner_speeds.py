"""How fast what is behind a part's own shaft turns at the start, by how its torque runs on.

While a flange is held, a shaft twists by the speed w of what is behind it: with k = -d(tau)/d(phi)
and the damper's d = -d(tau)/d(w_flange)

    d(tau)/dt = k w + d w', or k (w - w_flange) + d w' if the part turns the flange on by itself.

The acceleration w' is by what drives the inertia J behind it, even at rest, and by the shaft. The
torque's curvature is k w' + d w'', where J w'' = -d(tau)/dt; and a second trial, with the flange at
another speed, changes the rate by d^2/J of the difference. With its share s = d^2/(k J)

    w = (1 - s) d(tau)/dt / k - (d/k) d2(tau)/dt2 / k.
"""

import numpy as np

from herringbone.cosim.signature.laboratory import Laboratory
from herringbone.cosim.signature.rotation import InputRule
from herringbone.cosim.signature.trial import Refused

_SHARES = 0.25, 0.5, 0.75, 1.0
"""Of the step, after which torques are looked at."""
_POWERS = np.linalg.inv(np.vander(_SHARES, increasing=True))
"""Of the cubic through torques there."""
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

    def row_of(angle: int) -> int:
        return int(np.abs(known[:, angle]).argmax())

    def seen(angle: int, flange: float) -> tuple[float, float]:
        """Rate and curvature of the torque over k, with the flange at a speed."""
        row = row_of(angle)
        inputs = lab.start.copy()
        inputs[rate[angle]] = flange
        torques = [float(lab.run([inputs], lab.step * s)[-1][row]) for s in _SHARES]
        _, change, bend, _ = _POWERS @ (np.array(torques) - torques[0])
        per_angle = -lab.step * known[row, angle]
        return change / per_angle, 2.0 * bend / (per_angle * lab.step)

    def found(angle: int) -> float:
        if rate[angle] < 0 or not known[:, angle].any():
            return np.nan
        flange, row = float(lab.start[rate[angle]]), row_of(angle)
        turned_on = given[angle] is InputRule.START
        try:
            moved, bend = seen(angle, flange)
            apart = moved - flange * (not turned_on)
            if abs(apart) <= _ALIKE * max(abs(moved), abs(flange)):
                return flange
            again, _ = seen(angle, flange + apart)
        except Refused:
            return np.nan
        share = (again - moved) / apart + turned_on
        damped = known[row, rate[angle]] / known[row, angle]
        inner = (1.0 - share) * moved - damped * bend
        return flange * turned_on + inner if abs(share) < _STIFF else np.nan

    return tuple(map(found, range(len(lab.inputs))))

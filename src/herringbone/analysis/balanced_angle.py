"""Angles at which given torques balance, found as damped motion comes to rest.

A gearbox between two given torques is in equilibrium at some angles only: the energy of the meshes
changes over their phase, and its slope must be what the torques leave. Newton's method often does
not get there: within a clearance nothing holds a shaft, and once the teeth have parted, an
accelerating pinion looks nearly as good as an equilibrium.

Here the angle and the speed stay, and all else follows its rates f(x) by implicit Euler steps,

    (I / h - df/dx) step = f(x),

which go to stable rest as the motion would, the larger h the faster (pseudo-transient continuation,
C. T. Kelley and D. E. Keyes, SIAM J. Numer. Anal. 35 (1998) 508-523). What is left is the
acceleration of the speed over the angle. Where it changes its sign, the search begins again.
"""

from collections.abc import Iterator

import numpy as np
from scipy.optimize import brentq

from herringbone.analysis.rigid_rotation import rigid_rotation, steady_rows
from herringbone.analysis.slopes import slopes
from herringbone.analysis.twin.monolithic import Twin

_TURN, _TURNS = 0.02, 32
"""Between angles that are tried [rad], and how many: over two meshes of 20 teeth."""
_NEAR = 1e-6
"""How near to a balance the angle is brought [rad]."""
_STEPS = 400
_FIRST, _LONGEST = 1e-5, 1e4
"""Of Euler's steps [s]."""
_AT_REST = 1e-6
_STRAIGHT, _BENT = 0.05, 0.3
"""What a step leaves of what it was to do: below, the next is longer; above, it is not taken."""
_SMALL = 1.0
"""Over the size of a state: what is left is no matter then."""


def balanced_angles(twin: Twin, x: np.ndarray, scale: np.ndarray) -> Iterator[np.ndarray]:
    """States (n,) near equilibria, for a search to begin at.

    None where not one angle and one speed alone turn the whole drivetrain.

    Args:
        twin: the system.
        x: states (n,) to begin from.
        scale: sizes of the states (n,).
    """
    turning = np.flatnonzero(rigid_rotation(twin, x))
    rotating, _ = steady_rows(twin)
    if len(turning) != 1 or len(rotating) != 1:
        return
    angle, speed = int(rotating[0]), int(turning[0])
    rest = _Rest(twin, np.setdiff1d(np.arange(x.size), [angle, speed]), scale)
    found = rest.reached(x)
    if found is None:
        return
    for _ in range(_TURNS):
        before = found
        found = rest.reached(_turned(before, angle, before[angle] + _TURN))
        if found is None:
            return
        ends = before[angle], found[angle]
        if rest.rate(before)[speed] * rest.rate(found)[speed] > 0.0:
            continue

        def acceleration(at: float, near: np.ndarray = before) -> float:
            there = rest.reached(_turned(near, angle, at))
            return np.nan if there is None else float(rest.rate(there)[speed])

        balance = rest.reached(_turned(before, angle, brentq(acceleration, *ends, xtol=_NEAR)))
        if balance is not None:
            yield balance


def _turned(x: np.ndarray, angle: int, at: float) -> np.ndarray:
    turned = x.copy()
    turned[angle] = at
    return turned


class _Rest:
    """Where some states come to rest, while the others stay.

    Args:
        twin: the system.
        moving: these states.
        scale: sizes of all states (n,).
    """

    def __init__(self, twin: Twin, moving: np.ndarray, scale: np.ndarray) -> None:
        self._twin, self._moving, self._scale = twin, moving, scale

    def rate(self, x: np.ndarray) -> np.ndarray:
        """Derivatives (n,) of the states."""
        return self._twin.rhs(0.0, x)

    def reached(self, x: np.ndarray) -> np.ndarray | None:
        """The states (n,) at rest; None if they do not get there."""
        x, h, rate = x.copy(), _FIRST, self.rate(x)
        moving, size_of = self._moving, self._scale[self._moving]
        for _ in range(_STEPS):
            slope = slopes(self.rate, x, rate, self._scale, moving)[moving]
            euler = np.diag(size_of / h) - slope
            step = np.linalg.solve(euler, rate[moving])
            new = x.copy()
            new[moving] += step * size_of
            after = self.rate(new)
            change = (after - rate)[moving] - slope @ step
            left = np.abs(np.linalg.solve(euler, change)).max()
            size = np.abs(step).max()
            if not left <= max(_BENT * size, _SMALL):
                h *= 0.25
                continue
            x, rate = new, after
            if h >= _LONGEST and size < _AT_REST:
                return x
            h = min(h * (4.0 if left < _STRAIGHT * size + _AT_REST else 1.5), _LONGEST)
        return None

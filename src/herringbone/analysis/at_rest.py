"""Where states come to rest, found by long implicit steps of their damped motion.

States follow their rates f(x) by implicit Euler steps,

    (I / h - df/dx) step = f(x),

which go to stable rest as the motion would, the larger h the faster (pseudo-transient continuation,
C. T. Kelley and D. E. Keyes, SIAM J. Numer. Anal. 35 (1998) 508-523).
"""

from collections.abc import Callable

import numpy as np

from herringbone.analysis.slopes import slopes

_STEPS = 400
_FIRST, _LONGEST = 1e-5, 1e4
"""Of Euler's steps [s]."""
_AT_REST = 1e-6
_STRAIGHT, _BENT = 0.05, 0.3
"""What a step leaves of what it was to do: below, the next is longer; above, it is not taken."""
_KEPT = 0.01
"""As above: below, the slopes serve the next step, too."""
_SMALL = 1.0
"""Over the size of a state: what is left is no matter then."""


class Rest:
    """Where some states come to rest, while the others stay.

    Args:
        rate: derivatives (n,) of the states (n,).
        moving: these states.
        scale: sizes of all states (n,).
    """

    def __init__(
        self, rate: Callable[[np.ndarray], np.ndarray], moving: np.ndarray, scale: np.ndarray
    ) -> None:
        self.rate, self._moving, self._scale = rate, moving, scale

    def reached(self, x: np.ndarray) -> np.ndarray | None:
        """The states (n,) at rest; None if they do not get there."""
        if not self._moving.size:  # one free shaft between two torques: all of it stays
            return x.copy()
        x, h, rate = x.copy(), _FIRST, self.rate(x)
        moving, size_of = self._moving, self._scale[self._moving]
        taken_at = slope = None
        for _ in range(_STEPS):
            if slope is None:
                taken_at = x
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
                if taken_at is x:
                    h *= 0.25
                else:
                    slope = None
                continue
            x, rate = new, after
            if h >= _LONGEST and size < _AT_REST:
                return x
            if left > _KEPT * size + _AT_REST:
                slope = None
            faster = 4.0 if left < _STRAIGHT * size + _AT_REST else 1.5
            h = _LONGEST if size < _AT_REST else min(h * faster, _LONGEST)
        return None

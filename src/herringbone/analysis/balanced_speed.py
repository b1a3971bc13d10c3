"""The speed at which what drives and what loads a drivetrain balance.

Newton's method finds it from near by alone: far from it an accelerating shaft opens the teeth, and
nothing closes them again. Here the speed is given and the drivetrain speeds up evenly, which exists
at any speed. What is left is the acceleration over the speed; where it changes its sign, the search
begins again.
"""

from collections.abc import Iterator

import numpy as np

from herringbone.analysis.answered import NO_ANSWERS, Answered
from herringbone.analysis.balanced_angle import NoBalanceError
from herringbone.analysis.rigid_rotation import names_of_states
from herringbone.analysis.swung_out import even_rotation
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core import EquilibriumError
from herringbone.core.wording import option

_AT_REST = 100.0
"""Of the fastest shaft [rad/s], where the search begins at a drivetrain that does not turn."""
_STEP, _STEPS = 0.1, 8
"""First step over its speed, and how many, each twice the one before."""
_NEAR = 1e-6
"""How near to the balance the speed is brought, over the first one."""
_MOST = 30.0
"""Speeds, over the first one, at which a balance is looked for: drag alone makes none below."""


class _Speeds:
    """Even rotation of a drivetrain at given speeds of its fastest shaft.

    Attributes:
        fastest: place of the fastest shaft's speed among the states.
        first: speed [rad/s] at which the search begins.
        state: states (n,) at the last new one.
        tried: acceleration [rad/s^2] of the fastest shaft by its speed [rad/s].
    """

    def __init__(self, twin: Twin, answered: Answered, x: np.ndarray) -> None:
        self._twin, self._answered = twin, answered
        self.fastest, rotation = answered.kept[0], answered.rotation
        begin = abs(x[self.fastest]) or _AT_REST
        self.first = float(np.copysign(begin, x[self.fastest]))
        self.tried = dict[float, float]()
        self.state = np.where(rotation != 0.0, rotation * self.first, x)

    def acceleration(self, speed: float) -> float:
        """Of the fastest shaft [rad/s^2]; raises EquilibriumError."""
        if speed in self.tried:
            return self.tried[speed]
        answered = self._answered
        x = self.state + (speed - self.state[self.fastest]) * answered.rotation
        found = even_rotation(self._twin, answered, answered.kept, x)
        self.state = found[:-1]
        self.tried[speed] = float(found[-1])
        return self.tried[speed]


def balanced_speed(twin: Twin, x: np.ndarray) -> Iterator[np.ndarray]:
    """States (n,) near an equilibrium, for a search to begin at; none where none is found.

    Args:
        twin: the system; where no controller holds its speed.
        x: states (n,) to begin from.

    Raises:
        NoBalanceError: it speeds up at all speeds, and not one angle alone may make up for that,
            which `balanced_angles` tries.
    """
    from scipy.optimize import brentq  # noqa: PLC0415 (lazy)

    answered = Answered(twin, NO_ANSWERS, x, speeds_up=True)
    if not answered.kept:
        return
    speeds = _Speeds(twin, answered, x)
    try:
        if (ends := _bracket(speeds)) is not None:
            near = abs(speeds.first) * _NEAR
            brentq(speeds.acceleration, *ends, xtol=near, rtol=_NEAR)
    except EquilibriumError:
        return
    if ends is not None:
        yield speeds.state
    elif len(twin.turning) != 1:
        _refuse_unbalanced(twin.system.name, names_of_states(twin)[speeds.fastest], speeds.tried)


def _refuse_unbalanced(system: str, speed: str, tried: dict[float, float]) -> None:
    """Raise NoBalanceError."""
    first, *_, last = (f"{a:.4g} rad/s^2 at {w:.4g} rad/s" for w, a in tried.items())
    raise NoBalanceError(
        f"no steady rotation of '{system}' was found: {speed} changes by {first} and by {last}; "
        f"look for a torque that nothing balances, or start with {option('start', 'rest')}"
    )


def _bracket(speeds: _Speeds) -> tuple[float, float] | None:
    """Two speeds between which the acceleration changes its sign; None if none were found.

    Raises:
        EquilibriumError: at some speed there is no even rotation.
    """
    at, left = speeds.first, speeds.acceleration(speeds.first)
    step = np.copysign(_STEP * at, left)
    for _ in range(_STEPS):
        if (ahead := at + step) * at <= 0.0:  # it comes to a stop
            ahead = at / 4.0
        now = speeds.acceleration(ahead)
        if now * left <= 0.0:
            return at, ahead
        if abs(now - left) * _MOST * abs(at) < abs(left * (ahead - at)):
            return None
        at, left, step = ahead, now, 2.0 * step
    return None

"""Angles at which given torques balance, found as damped motion comes to rest.

A gearbox between two given torques is in equilibrium at some angles only: the energy of the meshes
changes over their phase, and its slope must be what the torques leave. Newton's method often does
not get there: within a clearance nothing holds a shaft, and once the teeth have parted, an
accelerating pinion looks nearly as good as an equilibrium.

Here the angle and the speed stay, and all else comes to rest (`analysis.at_rest`). What is left is
the acceleration of the speed over the angle. Where it changes its sign, the search begins again.
Where it is larger at all angles than the angle changes it, no angle balances these torques.
"""

from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache

import numpy as np

from herringbone.analysis.at_rest import Rest
from herringbone.analysis.rigid_rotation import names_of_states, rigid_rotation, steady_rows
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core import EquilibriumError
from herringbone.core.wording import option

_TURN, _TURNS = 0.02, 32
"""Between angles that are tried [rad], and how many: over two meshes of 20 teeth."""
_NEAR = 1e-6
"""How near to a balance the angle is brought [rad]."""


class NoBalanceError(EquilibriumError):
    """Given torques do not balance at any angle."""


def balanced_angles(twin: Twin, x: np.ndarray, scale: np.ndarray) -> Iterator[np.ndarray]:
    """States (n,) near equilibria, for a search to begin at.

    None where not one angle and one speed alone turn the whole drivetrain.

    Args:
        twin: the system.
        x: states (n,) to begin from.
        scale: sizes of the states (n,).

    Raises:
        NoBalanceError: after the last one, if angles change less than what the torques leave.
    """
    turning = np.flatnonzero(rigid_rotation(twin, x))
    rotating, _ = steady_rows(twin)
    if len(turning) != 1 or len(rotating) != 1:
        return
    angle, speed = int(rotating[0]), int(turning[0])
    moving = np.setdiff1d(np.arange(x.size), [angle, speed])
    rest = Rest(lambda x: twin.rhs(0.0, x), moving, scale)
    found = rest.reached(x)
    if found is None:
        return
    left = [rest.rate(found)[speed]]
    for _ in range(_TURNS):
        before = found
        found = rest.reached(_turned(before, angle, before[angle] + _TURN))
        if found is None:
            return
        left.append(rest.rate(found)[speed])
        ends = before[angle], found[angle]
        if left[-2] * left[-1] > 0.0:
            continue

        @cache
        def acceleration(at: float, near: np.ndarray = before) -> float:
            there = rest.reached(_turned(near, angle, at))
            return np.nan if there is None else float(rest.rate(there)[speed])

        balanced = _crossing(acceleration, ends)
        if balanced is None:
            continue
        balance = rest.reached(_turned(before, angle, balanced))
        if balance is not None:
            yield balance
    _refuse_unbalanced(twin, names_of_states(twin)[speed], np.array(left))


def _crossing(acceleration: Callable[[float], float], ends: tuple[float, float]) -> float | None:
    """Angle [rad] at which an acceleration vanishes between two ends.

    None if it does not: in a clearance it may jump, as the states come to rest on another flank if
    they come from the other end. None, too, where they come to no rest, of which it is nan.
    """
    from scipy.optimize import brentq  # noqa: PLC0415 (lazy)

    first, last = map(acceleration, ends)
    if not first * last <= 0.0:
        return None
    with suppress(ValueError):  # of nan between the ends
        return float(brentq(acceleration, *ends, xtol=_NEAR))
    return None


def _refuse_unbalanced(twin: Twin, speed: str, accelerations: np.ndarray) -> None:
    """Raise NoBalanceError if no angle could make up for the rates of a speed over the angle."""
    least = np.abs(accelerations).min()
    if least > np.ptp(accelerations):
        raise NoBalanceError(
            f"no steady rotation of '{twin.system.name}' was found: {speed} changes by "
            f"{least:.4g} rad/s^2 at any angle; look for a load there that nothing balances, or "
            f"start with {option('start', 'rest')}"
        )


def _turned(x: np.ndarray, angle: int, at: float) -> np.ndarray:
    turned = x.copy()
    turned[angle] = at
    return turned

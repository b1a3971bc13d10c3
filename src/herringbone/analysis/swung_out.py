"""States of a drivetrain that speeds up evenly, found as damped motion comes to rest.

Newton's method may open a mesh on its way, and does not close it again: within the clearance
nothing depends on where the teeth are. Motion does close it. Seen from the fastest shaft, which
stays, all else comes to rest (`analysis.at_rest`).
"""

import numpy as np

from herringbone.analysis.answered import Answered
from herringbone.analysis.at_rest import Rest
from herringbone.analysis.rotation_search import scales, steady_rotation
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core import EquilibriumError


def even_rotation(twin: Twin, answered: Answered, stay: list[int], x: np.ndarray) -> np.ndarray:
    """States and acceleration (n + 1,) of an even rotation: from a guess, or as motion comes there.

    Args:
        twin: of the components.
        answered: the same, with what others answer.
        stay: places of the states that keep their values.
        x: guess (n,).

    Raises:
        EquilibriumError: none was found.
    """
    try:
        return steady_rotation(twin.system, twin, stay, x, answered)[0]
    except EquilibriumError:
        if (near := swung_out(twin, answered, x)) is None:
            raise
        return steady_rotation(twin.system, twin, stay, near, answered)[0]


def swung_out(
    twin: Twin, answered: Answered, x: np.ndarray, angle: int | None = None
) -> np.ndarray | None:
    """States (n,) near an even rotation; None if nothing may speed up, or they do not get there.

    Args:
        twin: of the components.
        answered: the same, with what others answer.
        x: states (n,) to begin from; all shafts begin at the speed of the fastest one.
        angle: place of the one that stays; that of the fastest shaft if not given.
    """
    if not answered.kept:
        return None
    rotation, fastest = answered.rotation, answered.kept[0]
    begin = np.where(rotation != 0.0, rotation * x[fastest], x)
    if angle is None:
        speed, angle = fastest, next(iter(_turned_by(twin, x, fastest)), None)
    else:
        known = map(int, np.flatnonzero(rotation))
        of_angle = (i for i in known if angle in _turned_by(twin, x, i))
        speed = next(of_angle, fastest)
    if angle is None:
        return None
    turned = twin.rhs(0.0, begin + rotation) - twin.rhs(0.0, begin)
    turning_on = np.zeros_like(x)
    turning_on[twin.turning] = turned[twin.turning] * x[fastest]

    def rate(x: np.ndarray) -> np.ndarray:
        even, faster = (_rate(twin, answered, x, a) for a in (0.0, 1.0))
        if not (np.isfinite(even).all() and np.isfinite(faster).all()):
            return np.full_like(even, np.inf)
        by_acceleration = faster - even
        a = even[speed] / (rotation[speed] - by_acceleration[speed])
        return even + a * (by_acceleration - rotation) - turning_on

    moving = np.setdiff1d(np.arange(x.size), [angle, speed])
    return Rest(rate, moving, scales(twin)).reached(begin)


def _turned_by(twin: Twin, x: np.ndarray, speed: int) -> list[int]:
    """The states that turn by a speed, by their places."""
    faster = x.copy()
    faster[speed] += 1.0
    change = np.abs(twin.rhs(0.0, faster) - twin.rhs(0.0, x))
    return [i for i in twin.turning if change[i] > 0.0]


def _rate(twin: Twin, answered: Answered, x: np.ndarray, acceleration: float) -> np.ndarray:
    """Rates (n,) under what is answered at an acceleration of the fastest shaft [rad/s^2]."""
    answered.set(np.append(x, acceleration))
    return twin.rhs(0.0, x)

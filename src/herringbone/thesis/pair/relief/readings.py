"""Stiffness with the thesis' relief over phase and torque, by finite elements."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from herringbone.gears import MeshStiffness
from herringbone.gears.stiffness.methods import METHODS
from herringbone.gears.stiffness.point_mesh import silent
from herringbone.thesis.pair.finite_elements import TORQUES, by_elements, loads, modification
from herringbone.thesis.pair.given import JOB

TIPS = {"pinion": "at the pinion's tip", "both": "at both tips"}
"""Where the relief is; the thesis does not say."""
AMOUNTS = (5.0, 10.0)
"""Delta_max of the thesis [um]."""
PUBLISHED_CHANGE = -0.95
"""Of the stiffness by 10 um [%]."""

_PHASES = 32
"""Of which a mean is taken."""
READINGS: dict[str, Callable[[MeshStiffness], np.ndarray]] = {
    "mean": lambda found: found.secant[1:].mean(axis=1),
    "peak": lambda found: found.secant[1:].max(axis=1),
    "tangent": lambda found: found.tangent[1:].mean(axis=1),
}
"""What "stiffness amplitude" may be: a number for each torque, of one half."""
TOLD = {
    "mean": "mean of Fₙ/δₙ",
    "peak": "largest Fₙ/δₙ of a mesh period",
    "tangent": "mean of the tangent dFₙ/dδₙ",
}


def relief(tips: str, amount: float) -> MeshStiffness:
    """Stiffness with a relief.

    Args:
        tips: of `TIPS`.
        amount: [um].
    """
    return by_elements(f"{tips} {amount:g}")


def change(tips: str, amount: float, reading: str) -> np.ndarray:
    """Change of the stiffness at `TORQUES` against that without relief [%]."""
    read = READINGS[reading]
    return 100.0 * (read(relief(tips, amount)) / read(by_elements()) - 1.0)


def change_by(method: str, tips: str) -> np.ndarray:
    """Change of the mean stiffness by the largest relief at `TORQUES`, by a method of slices [%].

    Args:
        method: of `gears.stiffness.methods`.
        tips: of `TIPS`.
    """
    plain, relieved = (
        METHODS[method].mesh(replace(JOB.task(), modification=modification(name)), silent)
        for name in ("none", f"{tips} {AMOUNTS[-1]:g}")
    )
    means = (mesh.solve(loads(), _PHASES).secant[1:].mean(axis=1) for mesh in (relieved, plain))
    return 100.0 * (next(means) / next(means) - 1.0)


def change_at(changes: np.ndarray, torque: float) -> float:
    """Change [%] at a torque [N m], between those at `TORQUES`; as `torque_of` does it."""
    return -float(np.exp(np.interp(np.log(torque), np.log(TORQUES), np.log(-changes))))


def torque_of(changes: np.ndarray, wanted: float = PUBLISHED_CHANGE) -> float:
    """Torque [N m] from which on a change [%] is smaller than wanted; changes fade with torque.

    Not a number if it is not reached.
    """
    logs = np.log(-changes)
    torque = np.interp(-np.log(-wanted), -logs, np.log(TORQUES), right=np.nan)
    return float(np.exp(torque))

"""Loads beyond those that the stiffness table was made for."""

import numpy as np

from herringbone.components.gear_mesh import layout as at
from herringbone.core import Beyond
from herringbone.kernels import force_law
from herringbone.kernels.compiling.jit import kernel

_LINE = (
    "the meshes carry %g N (left) and %g N (right), but the stiffness table ends at %g N, which is "
    "%g N.m at the pinion: above, the law goes on as a straight line, and no teeth were computed "
    "for that; look at the torques"
)


@kernel
def _beyond(b: np.ndarray, which: int, report: np.ndarray) -> int:
    left, right = abs(b[at.FORCE[0]]), abs(b[at.FORCE[1]])
    ends_left = force_law.largest_force(b, at.TABLE[0])
    ends_right = force_law.largest_force(b, at.TABLE[1])
    report[0], report[1], report[2] = left, right, min(ends_left, ends_right)
    report[3] = (ends_left + ends_right) * b[at.COS] * b[at.RB[0]]
    return 1 if left > ends_left or right > ends_right else 0


BEYOND = Beyond(_beyond, (_LINE,))

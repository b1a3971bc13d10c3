"""The stiffness tables of a gear pair, with few harmonics of the mesh."""

import numpy as np

from herringbone.components.gear_mesh import layout as at
from herringbone.components.resources import tooth_deviations
from herringbone.core.declaring.roles import SIDES
from herringbone.kernels import force_law

_HEAD = 2
"""Numbers of a table part before its nodes."""
_DEVIATE = "teeth that deviate have force laws of their own"
_SOFT = "with so few, the stiffness of teeth that hardly touch would fall below zero"


def keep_harmonics(block: np.ndarray, count: int) -> str:
    """Keep so many mesh harmonics of the stiffness at each deflection, on both sides.

    All that a node has is linear in the table, and shifts with it, so that energy and force still
    belong together.

    Args:
        block: with its tables.
        count: harmonics; 0: the means alone.

    Returns:
        Why that cannot be, with the block as it was; "" if it is done.
    """
    sides = [(side, flank) for side in range(len(SIDES)) for flank in range(2)]
    if any(tooth_deviations.given(block, at.DEVIATIONS, *own) for own in sides):
        return _DEVIATE
    tables = [_kept(block[first : first + force_law.TABLE_SIZE], count) for first in at.TABLE]
    if any(_least_stiffness(table) <= 0.0 for table in tables):
        return _SOFT
    for first, table in zip(at.TABLE, tables, strict=True):
        block[first : first + force_law.TABLE_SIZE] = table
    return ""


def _kept(table: np.ndarray, count: int) -> np.ndarray:
    """A table part with its first harmonics."""
    nodes = table[_HEAD:].reshape(force_law.PHASES, -1)
    lines = np.fft.rfft(nodes, axis=0)
    lines[count + 1 :] = 0.0
    return np.concatenate([table[:_HEAD], np.fft.irfft(lines, force_law.PHASES, axis=0).ravel()])


def _least_stiffness(table: np.ndarray) -> float:
    """The least tangent stiffness at the nodes, of an almost open contact, too [N/m]."""
    nodes = table[_HEAD:].reshape(force_law.PHASES, -1, force_law.NODE)
    u = np.arange(force_law.DEFLECTIONS)
    return float((nodes[:, :, 0] + 0.5 * u * nodes[:, :, 2]).min())

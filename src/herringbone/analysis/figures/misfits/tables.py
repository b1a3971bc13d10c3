"""The stiffness table: whose it is, and its load range against the forces of the run."""

import math
from collections.abc import Iterator

import numpy as np

from herringbone.analysis.asked import mesh_forces, resource_file
from herringbone.components.resources.flat_csv import read_header
from herringbone.components.resources.stiffness_table import PAIR, read_stiffness_table
from herringbone.core import ResourceError
from herringbone.core.declaring.roles import SIDES, Quantity
from herringbone.result.result import Result

_JUMP = 2.0
"""Neighbours in phase, of which one has more than so many times the stiffness of the other, are
noted: from two pairs of teeth in contact to one, the steepest step of a spur pair, it is halved at
most, as no pair is stiffer where it enters or leaves than in the middle of its path."""


def _of_jumps(gear: str, side: str, loads: np.ndarray, stiffness: np.ndarray) -> Iterator[str]:
    """A line on the largest jump of a side, at the largest load; (loads, phases) [N/m]."""
    phases = stiffness.shape[1]
    curve = stiffness[-1]
    ratio = np.abs(np.log(np.roll(curve, -1) / curve))
    at = int(np.argmax(ratio))
    if ratio[at] > math.log(_JUMP):
        yield (
            f"{gear}: the stiffness of the {side} mesh jumps from {curve[at]:.4g} to "
            f"{curve[(at + 1) % phases]:.4g} N/m between phases {at / phases:.4g} and "
            f"{(at + 1) / phases:.4g} at {loads[-1]:.4g} N: is a value of its table wrong?"
        )


def of_table(result: Result, gear: str) -> Iterator[str]:
    """Lines on the stiffness table of a gear pair."""
    file = resource_file(result, gear, Quantity.STIFFNESS_TABLE)
    if file is None:
        return
    try:
        tables = read_stiffness_table(file)
    except ResourceError:  # it was read when the run began
        return
    if np.isnan(read_header(file, *PAIR)).any():
        yield (
            f"{gear}: its stiffness table {file} does not tell of which pair it is, so that this "
            "was not tested; those that 'herringbone gear' writes do"
        )
    for side, (loads, stiffness) in zip(SIDES, tables, strict=True):
        yield from _of_jumps(gear, side, loads, stiffness)
        force = mesh_forces(result, gear).get(side)
        largest = float(result.data[force].abs().max()) if force in result.data else 0.0
        if largest > loads[-1]:
            yield (
                f"{gear}: the {side} mesh carries up to {largest:.4g} N, its stiffness table ends "
                f"at {loads[-1]:.4g} N: above that the law goes on as a straight line"
            )

"""Run-ups: cycles of the pinion, orders and waterfalls of recorded columns."""

import math
from typing import NamedTuple

import numpy as np

from herringbone.analysis.asked import parameter, signal
from herringbone.analysis.figures.order_tracking import (
    FrequencyMap,
    OrderMap,
    frequency_map,
    growing,
    order_map,
)
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.result.result import TIME, Result

BLOCK = 12.0
"""Mesh periods in a block: a resolution of 1/12 mesh order."""
HIGHEST = 6.0
"""Mesh order up to which orders are tracked."""
_CHANGES = 0.1
_DURATION_SHARE = 0.06


class Rotation(NamedTuple):
    """A gear pair's rotation where it turns in one direction: the longest such stretch of a run.

    Attributes:
        rows: of the equidistant table.
        time: (n,) [s].
        cycles: (n,) mesh periods in that direction, since the start.
        speed: (n,) of the pinion in that direction [rad/s].
        teeth: of the pinion.
    """

    rows: slice
    time: np.ndarray
    cycles: np.ndarray
    speed: np.ndarray
    teeth: float


def speed_changes(result: Result) -> bool:
    """True if the pinion's speed changes by more than a tenth of its largest value."""
    speed = signal(result, Role.GEAR_PAIR, Quantity.SPEED, "pinion")
    if speed is None or len(speed) < 2 or result.outcome.unstable:
        return False
    return bool(np.ptp(speed) > _CHANGES * np.abs(speed).max())


def rotation(result: Result, gear: str = "") -> Rotation:
    """Cycles of the mesh by the integral of the pinion's speed (trapezoids).

    Args:
        result: of a run, records equidistant.
        gear: name of the gear pair; the first one if not given.

    Raises:
        ParameterError: no gear pair of known teeth recorded its speed, or it never turns.
    """
    speed = signal(result, Role.GEAR_PAIR, Quantity.SPEED, "pinion", part=gear)
    gears = (gear,) if gear else result.parts_with(Role.GEAR_PAIR)[:1]
    teeth = parameter(result, gears[0], Quantity.NUMBER_OF_TEETH, "pinion") if gears else None
    if speed is None or teeth is None:
        raise ParameterError(
            f"system '{result.info.system}' records no speed of a gear pair of known teeth"
        )
    time = result.data[TIME].to_numpy()
    steps = 0.5 * (speed[1:] + speed[:-1]) * np.diff(time)
    turned = np.concatenate([[0.0], np.cumsum(steps)]) * teeth / (2.0 * math.pi)
    ways = [(growing(sign * turned), sign * turned, sign * speed) for sign in (1.0, -1.0)]
    rows, cycles, forward = max(ways, key=lambda way: way[0].stop - way[0].start)
    if rows.stop - rows.start < 2:
        raise ParameterError("the pinion does not turn: no orders")
    return Rotation(rows, time[rows], cycles[rows], forward[rows], teeth)


def _turning(result: Result, column: str, gear: str) -> tuple[Rotation, np.ndarray]:
    """How a pair turns, and the values (n,) of a column at these rows."""
    result = result.uniform()
    turning = rotation(result, gear)
    return turning, result[column].to_numpy(float)[turning.rows]


def tracked(
    result: Result,
    column: str,
    *,
    block: float = BLOCK,
    highest: float = HIGHEST,
    gear: str = "",
) -> OrderMap:
    """Mesh orders of a column over a run; `speed` is the mesh frequency of each block [Hz].

    Args:
        result: of a run.
        column: of a real output.
        block: mesh periods in a block; orders are multiples of 1 / block.
        highest: mesh order.
        gear: name of the gear pair; the first one if not given.

    Raises:
        ParameterError: see `rotation`, `order_map`; or there is no such column.
    """
    turning, values = _turning(result, column, gear)
    return order_map(turning.time, turning.cycles, values, block, highest)


def waterfall(
    result: Result, column: str, *, duration: float | None = None, gear: str = ""
) -> FrequencyMap:
    """Spectra of a column over a run; `speed` is that of the pinion [rad/s].

    Args:
        result: of a run.
        column: of a real output.
        duration: of a block [s]; 6 % of the run if not given.
        gear: name of the gear pair; the first one if not given.

    Raises:
        ParameterError: see `rotation`, `frequency_map`; or there is no such column.
    """
    turning, values = _turning(result, column, gear)
    span = float(turning.time[-1] - turning.time[0])
    block = _DURATION_SHARE * span if duration is None else duration
    return frequency_map(turning.time, turning.speed, values, block)

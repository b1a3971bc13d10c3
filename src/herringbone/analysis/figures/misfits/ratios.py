"""Gear ratios: of the teeth, and of what controls the torque."""

from collections.abc import Iterator

from herringbone.analysis.asked import of_both_gears, parameter
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.result.result import Result

_OFF = 1e-3
"""Relative deviation of a ratio that is noted."""


def of_ratio(result: Result, gear: str) -> Iterator[str]:
    """Lines on controllers with another ratio than the only gear pair."""
    teeth = of_both_gears(result, gear, Quantity.NUMBER_OF_TEETH)
    if teeth is None or len(result.parts_with(Role.GEAR_PAIR)) > 1:
        return
    ratio = teeth[1] / teeth[0]
    for part in result.parts_with(Role.CONTROLLER):
        own = parameter(result, part, Quantity.GEAR_RATIO)
        if own is not None and abs(own / ratio - 1.0) > _OFF:
            yield (
                f"{part} has a gear ratio of {own:.5g}, {gear} {teeth[0]:g}/{teeth[1]:g} teeth, "
                f"which is {ratio:.5g}: the torques are not those of one load"
            )

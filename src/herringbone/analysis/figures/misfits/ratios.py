"""Gear ratios: of the teeth, and of what controls the torque."""

from collections.abc import Iterator

from herringbone.analysis.asked import of_both_gears, parameter
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.result.result import Result

_OFF = 1e-3
"""Relative deviation of a ratio that is noted."""


def of_ratio(result: Result, gear: str) -> Iterator[str]:
    """Lines on controllers with another ratio than the only gear pair.

    Beside one that has it, a controller with the ratio 1 commands the pinion's own torque.
    """
    teeth = of_both_gears(result, gear, Quantity.NUMBER_OF_TEETH)
    if teeth is None or len(result.parts_with(Role.GEAR_PAIR)) > 1:
        return
    ratio = teeth[1] / teeth[0]
    controllers = result.parts_with(Role.CONTROLLER)
    found = {part: parameter(result, part, Quantity.GEAR_RATIO) for part in controllers}
    fits = {part: own is None or abs(own / ratio - 1.0) <= _OFF for part, own in found.items()}
    for part, own in found.items():
        if not fits[part] and not (own == 1.0 and any(fits.values())):
            yield (
                f"{part} has a gear ratio of {own:.5g}, {gear} {teeth[0]:g}/{teeth[1]:g} teeth, "
                f"which is {ratio:.5g}: the torques are not those of one load"
            )

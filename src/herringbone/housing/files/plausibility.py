"""What no housing of a gearbox has, though it could be computed: units, supports, seats."""

import itertools
import math
from collections.abc import Iterator

import numpy as np

from herringbone.core.declaring.roles import GEARS, HALVES, SIDES
from herringbone.housing.modal_model import AXES, ModalHousing

_STIFFNESS, _OFF = 1e9, 1e3
"""Order of the static stiffness at a seat of a housing [N/m]; how far off it is noted."""
_SAME = 1e-6
"""Seats whose shapes agree within this share are one."""


def implausible(housing: ModalHousing) -> Iterator[str]:
    """Lines on what is hardly meant; nothing of it is refused."""
    yield from _of_units(housing)
    still = int(np.count_nonzero(housing.frequency_hz == 0.0))
    if still:
        held = f", though its boundary is '{housing.boundary}'" if housing.boundary else ""
        yield (
            f"{still} modes are at 0 Hz{held}: the housing is not held, and drifts under a "
            "constant force; are supports missing?"
        )
    count = len(AXES)
    shapes = {name: housing.seat_shapes[count * n :][:count] for n, name in enumerate(HALVES)}
    for one, other in itertools.combinations(HALVES, 2):
        if np.abs(shapes[one] - shapes[other]).max() <= _SAME * np.abs(shapes[one]).max():
            yield f"seats {one} and {other} move alike in all modes: are they the same nodes?"
    yield from _of_sides(housing)


def _of_sides(housing: ModalHousing) -> Iterator[str]:
    """A line for each shaft whose left seat is not at larger z than its right one."""
    along = {point.name: 1e3 * point.position[2] for point in housing.points}
    for gear in GEARS:
        left, right = (f"{gear}_{side}" for side in SIDES)
        if along[left] <= along[right]:
            yield (
                f"{left} lies at z = {along[left]:.1f} mm, {right} at {along[right]:.1f} mm: left "
                "is +z; are seats exchanged, or is the frame another one?"
            )


def _of_units(housing: ModalHousing) -> Iterator[str]:
    """A line if the static stiffness is of another order than that of any housing."""
    compliance = np.diag(housing.static_compliance() if housing.static is None else housing.static)
    compliance = compliance[compliance > 0.0]
    if not compliance.size:
        return
    stiffness = math.exp(-float(np.log(compliance).mean()))
    if not 1.0 / _OFF < stiffness / _STIFFNESS < _OFF:
        yield (
            f"the static stiffness at the seats is {stiffness:.3g} N/m in the mean, that of "
            f"housings is about {_STIFFNESS:g} N/m: are lengths, masses or shapes of another unit?"
        )

"""Gears that leave their axes too far for equations of small motions."""

from collections.abc import Iterator

from herringbone.analysis.asked import parameter
from herringbone.core.declaring.roles import PortKind, Quantity
from herringbone.result.result import Result

_FAR = 0.01
"""Share of the base radius that an axis moves, from which the mesh would be another one."""


def of_axes(result: Result, gear: str) -> Iterator[str]:
    """A line on the half that moves farthest along the line of action, if that is too far."""
    worst, place, radius = _FAR, "", 0.0
    for port in result.info.anatomy.ports(gear, PortKind.JOURNAL):
        column = f"{gear}.{port.name}.s_y"
        base = parameter(result, gear, Quantity.BASE_RADIUS, port.place.partition("_")[0])
        if column not in result.data or not base:
            continue
        share = float(result.data[column].abs().max()) / base
        if share > worst:
            worst, place, radius = share, column, base
    if place:
        yield (
            f"{place} comes to {1e3 * worst * radius:.3g} mm, at a base radius of "
            f"{1e3 * radius:.1f} mm: the mesh takes axes to stay; is a stiffness of bearings or "
            "housing in another unit than N/m?"
        )
